#pragma once
// Which triangles meet at each vertex.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gatelight::neural {

using TriangleCorners = std::array<std::uint32_t, 3>;

/// The corners 3 * triangle + corner at vertex v are corners[offsets[v]] .. corners[offsets[v + 1]-1], in
/// ascending order.
struct VertexCorners {
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> corners;
};

VertexCorners build_vertex_corners(std::span<const TriangleCorners> triangles, std::uint32_t vertex_count);

}  // namespace gatelight::neural
