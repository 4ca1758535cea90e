#pragma once
// A scene as the cache knows it: welded meshes, instances, and the sides that have storage.

#include <span>
#include <vector>

#include "neural/layout/surface_layout.h"
#include "renderer/surface/ray.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The meshes of a scene with one vertex for each position. Spans of layouts point into it.
class WeldedMeshes {
 public:
  explicit WeldedMeshes(const scene::Scene& scene);
  /// One of the sides and scales of the node spacing for each instance; no scales: 1.
  neural::SurfaceLayout layout(const scene::Scene& scene, const std::vector<neural::Sides>& sides,
                               const std::vector<float>& spacing_scales = {}) const;

 private:
  std::vector<std::vector<neural::Float3>> positions_;
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles_;
};

/// Sides that a material lets light meet: both where it is double-sided or transmits, else the front.
neural::Sides possible_sides(const scene::Scene& scene, const scene::Instance& instance);

/// The surface whose triangle a ray in `direction` met.
std::uint32_t seen_surface(const scene::Scene& scene, const Hit& hit, const Vec3& direction);

inline bool has_side(neural::Sides sides, std::uint32_t side) {
  return ((static_cast<unsigned>(sides) >> side) & 1u) != 0;
}

}  // namespace gatelight::renderer
