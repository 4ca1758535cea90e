#include "scene/finish.h"

#include <fmt/format.h>

#include "scene/bake.h"
#include "scene/coincident_emitters.h"
#include "scene/coincident_surfaces.h"

namespace gatelight::scene {

std::vector<int> finish_geometry(Scene& scene, bool bake) {
  if (bake) bake_transforms(scene);
  std::vector<int> culled_copies = separate_coincident_emitters(scene);
  separate_coincident_surfaces(scene);
  scene.bounds = compute_bounds(scene);
  return culled_copies;
}

std::string wrong_bounds(const Scene& scene, const Box& bounds) {
  constexpr float kLargestCoordinate = 1e9f;
  if (bounds.isEmpty() && scene.instances.empty()) return "";
  if (bounds.isEmpty() && !scene.bounds.isEmpty()) return "";
  const Vec3 furthest =
      (scene.origin + bounds.min()).cwiseAbs().cwiseMax((scene.origin + bounds.max()).cwiseAbs());
  if (furthest.allFinite() && furthest.maxCoeff() <= kLargestCoordinate) return "";
  return fmt::format("a vertex at ({}, {}, {}), expected at most {:g} from the origin", furthest.x(),
                     furthest.y(), furthest.z(), kLargestCoordinate);
}

}  // namespace gatelight::scene
