#include "apps/view/scene_outline.h"

#include <algorithm>

#include "scene/light_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

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
  ordered_json cameras = ordered_json::array(), animations = ordered_json::array();
  for (const scene::Camera& camera : scene.cameras)
    cameras.push_back(
        {{"name", camera.name.empty() ? camera.node : camera.name}, {"orthographic", camera.orthographic}});
  for (const scene::Animation& animation : scene.animations)
    animations.push_back({{"name", animation.name}, {"seconds", animation.seconds}});
  for (const scene::Instance& instance : scene.instances) {
    outline.instances.push_back(instance.name);
    outline.boxes.push_back(box_of(scene, instance));
    outline.placements.push_back(instance.placement);
  }
  const bool empty = scene.bounds.isEmpty();
  const Vec3 center = empty ? Vec3(0.0f, 0.0f, 0.0f) : Vec3(scene.bounds.center() + scene.origin);
  const float radius = empty ? 1.0f : std::max(0.5f * scene.bounds.diagonal().norm(), 1e-6f);
  const scene::LightNames names(scene);
  outline.json = {
      {"cameras", cameras},
      {"lights", names.lights},
      {"glowing", names.materials},
      {"animations", animations},
      {"center", {center.x(), center.y(), center.z()}},
      {"radius", radius},
      {"has_own_light", !scene.lights.empty() || !names.materials.empty() || scene.image_light.has_value()}};
  return outline;
}

}  // namespace gatelight::apps
