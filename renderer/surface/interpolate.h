#pragma once
// Vertex attributes at a point of a triangle.

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

using Corners = std::array<std::uint32_t, 3>;

/// `weights` are for the three corners.
template <typename T>
T interpolate(const std::vector<T>& values, const Corners& c, const Vec3& weights) {
  return values[c[0]] * weights.x() + values[c[1]] * weights.y() + values[c[2]] * weights.z();
}

inline const std::vector<Vec2>& uv_set(const scene::Mesh& mesh, const scene::TextureSlot& slot) {
  return slot.texcoord == 0 ? mesh.uv0 : mesh.uv1;
}

/// The coordinates that a slot reads; zero if the mesh has none.
inline Vec2 uv_at(const scene::Mesh& mesh, const scene::TextureSlot& slot, const Corners& corners,
                  const Vec3& weights) {
  const std::vector<Vec2>& uv = uv_set(mesh, slot);
  return uv.empty() ? Vec2(Vec2::Zero()) : interpolate(uv, corners, weights);
}

}  // namespace gatelight::renderer
