#pragma once
// Connects the corners of a mesh's triangles. Corner c belongs to triangle c / 3, and its edge leads to the
// next corner of that triangle.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/math.h"

namespace gatelight::scene {

using Triangle = std::array<std::uint32_t, 3>;

inline constexpr std::uint32_t kNoCorner = std::numeric_limits<std::uint32_t>::max();

inline std::uint32_t next_corner(std::uint32_t c) {
  return c % 3 == 2 ? c - 2 : c + 1;
}
inline std::uint32_t previous_corner(std::uint32_t c) {
  return c % 3 == 0 ? c + 2 : c - 1;
}

/// Whether two corners lie at one place.
inline bool is_degenerate(const Triangle& t, std::span<const Vec3> positions) {
  const Vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
  return a == b || b == c || c == a;
}

/// Returns for each vertex the first one of equal position, normal and texture coordinates. `uv` may be
/// empty.
std::vector<std::uint32_t> weld_vertices(std::span<const Vec3> positions, std::span<const Vec3> normals,
                                         std::span<const Vec2> uv);

/// Returns for each corner that of the other triangle with the same edge, which runs through it in the
/// opposite direction, or kNoCorner. At an edge of more triangles, pairs are made in the order of the
/// triangles. `welded` maps the triangles' indices to vertices. Degenerate triangles have no neighbours.
std::vector<std::uint32_t> connect_edges(std::span<const Triangle> triangles, std::span<const Vec3> positions,
                                         std::span<const std::uint32_t> welded);

}  // namespace gatelight::scene
