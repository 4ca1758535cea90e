#pragma once
// The layout of a scene for the cache: welded meshes, instances, and the sides that have storage.

#include <span>
#include <vector>

#include "neural/layout/surface_layout.h"
#include "renderer/surface/ray.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The meshes of a scene with one vertex for each position. Layouts have spans into this object.
class WeldedMeshes {
 public:
  explicit WeldedMeshes(const scene::Scene& scene);
  /// `sides` and `spacing_scales` have one entry for each instance; without scales all are 1.
  neural::SurfaceLayout layout(const scene::Scene& scene, const std::vector<neural::Sides>& sides,
                               const std::vector<float>& spacing_scales = {}) const;

 private:
  std::vector<std::vector<neural::Float3>> positions_;
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles_;
};

/// Sides that light can reach: both where the material is double-sided or transmits, else the front.
neural::Sides possible_sides(const scene::Scene& scene, const scene::Instance& instance);

/// The surface (neural::surface_index) that a ray in `direction` hit.
std::uint32_t surface_of_hit(const scene::Scene& scene, const Hit& hit, const Vec3& direction);

inline bool has_side(neural::Sides sides, std::uint32_t side) {
  return ((static_cast<unsigned>(sides) >> side) & 1u) != 0;
}

}  // namespace gatelight::renderer
