#include "scene/bounds.h"

#include <utility>

namespace gatelight::scene {
namespace {

/// Transforming this many takes half a second.
constexpr std::size_t kExactVertices = 100'000'000;

}  // namespace

Box compute_bounds(const Scene& scene) {
  std::size_t work = 0;
  for (const Instance& instance : scene.instances) work += scene.mesh_of(instance).positions.size();
  const bool exact = work <= kExactVertices;

  std::vector<Box> local(scene.meshes.size());
  for (std::size_t i = 0; i < local.size(); ++i) {
    for (const Vec3& p : scene.meshes[i].positions) local[i].extend(p);
  }
  Box bounds;
  for (const Instance& instance : scene.instances) {
    const Box& box = local[static_cast<std::size_t>(instance.mesh)];
    if (box.isEmpty()) continue;
    if (instance.baked) {
      bounds.extend(box);
    } else if (exact) {
      for (const Vec3& p : scene.mesh_of(instance).positions) bounds.extend(instance.transform * p);
    } else {
      for (int corner = 0; corner < 8; ++corner) {
        bounds.extend(instance.transform * box.corner(static_cast<Box::CornerType>(corner)));
      }
    }
  }
  return bounds;
}

void drop_unused_meshes(Scene& scene) {
  std::vector<int> number(scene.meshes.size(), -1);
  for (const Instance& instance : scene.instances) number[static_cast<std::size_t>(instance.mesh)] = 0;
  std::vector<Mesh> kept;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(scene.meshes[i]));
  }
  scene.meshes = std::move(kept);
  for (Instance& instance : scene.instances) instance.mesh = number[static_cast<std::size_t>(instance.mesh)];
}

}  // namespace gatelight::scene
