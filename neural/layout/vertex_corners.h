#pragma once
// The triangles that meet at each vertex.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gatelight::neural {

/// Triangles or vertices per task, at least.
inline constexpr std::size_t kGrain = 8192;

using TriangleCorners = std::array<std::uint32_t, 3>;

/// Vertex v has the corners corners[offsets[v]] .. corners[offsets[v + 1] - 1], ascending; each is 3 *
/// triangle + corner.
struct VertexCorners {
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> corners;
};

VertexCorners build_vertex_corners(std::span<const TriangleCorners> triangles, std::uint32_t vertex_count);

}  // namespace gatelight::neural
