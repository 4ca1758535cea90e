#include "apps/view/scene_outline.h"

#include <algorithm>

#include "scene/light_names.h"

namespace gatelight::apps {
namespace {

/// In the file's coordinates.
Box box_of(const scene::Scene& scene, const scene::Instance& instance) {
  Box box;
  const scene::Mesh& mesh = scene.mesh_of(instance);
  for (const Vec3& position : mesh.positions)
    box.extend(instance.baked ? position : Vec3(instance.transform * position));
  return box.isEmpty() ? box : Box(box.min() + scene.origin, box.max() + scene.origin);
}

}  // namespace

std::optional<Box> SceneOutline::object_around(std::size_t instance) const {
  if (instance >= boxes.size()) return std::nullopt;
  Box box;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (placements[i] == placements[instance] && !boxes[i].isEmpty()) box.extend(boxes[i]);
  }
  if (box.isEmpty()) return std::nullopt;
  return box;
}

SceneOutline outline_of(const scene::Scene& scene) {
  SceneOutline outline;
  for (const scene::Camera& camera : scene.cameras)
    outline.cameras.push_back({camera.name.empty() ? camera.node : camera.name, camera.orthographic});
  const scene::LightNames names(scene);
  outline.lights.assign(names.lights.begin(), names.lights.end());
  outline.glowing.assign(names.materials.begin(), names.materials.end());
  outline.animations = scene.animations;
  for (const scene::Instance& instance : scene.instances) {
    outline.instances.push_back(instance.name);
    outline.boxes.push_back(box_of(scene, instance));
    outline.placements.push_back(instance.placement);
  }
  if (!scene.bounds.isEmpty()) {
    outline.center = scene.bounds.center() + scene.origin;
    outline.radius = std::max(0.5f * scene.bounds.diagonal().norm(), 1e-6f);
  }
  outline.has_own_light = !scene.lights.empty() || !names.materials.empty() || scene.image_light;
  return outline;
}

}  // namespace gatelight::apps
