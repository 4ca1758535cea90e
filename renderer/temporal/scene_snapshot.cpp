#include "renderer/temporal/scene_snapshot.h"

namespace gatelight::renderer {

SceneSnapshot::SceneSnapshot(const scene::Scene& scene) {
  if (scene.motion.materials) materials_ = scene.materials;
  if (!scene.motion.instances) return;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    if (!instance.moves) continue;
    moving_[i] = {instance.transform, instance.hidden};
    const scene::Mesh& mesh = scene.mesh_of(instance);
    if (mesh.deforming >= 0)
      deforming_.try_emplace(instance.mesh, mesh.positions.begin(), mesh.positions.end());
  }
}

std::optional<std::array<Vec3, 3>> SceneSnapshot::triangle(const scene::Scene& scene, std::uint32_t instance,
                                                           std::uint32_t primitive) const {
  const scene::Instance& now = scene.instances[instance];
  const auto place = moving_.find(instance);
  if (place == moving_.end()) return scene::world_triangle(scene, now, primitive);
  if (place->second.hidden) return std::nullopt;
  const scene::Mesh& mesh = scene.mesh_of(now);
  const auto deformed = deforming_.find(now.mesh);
  if (deformed != deforming_.end() && deformed->second.size() != mesh.positions.size()) return std::nullopt;
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t vertex = mesh.triangles[primitive][k];
    const Vec3& p = deformed == deforming_.end() ? mesh.positions[vertex] : deformed->second[vertex];
    corners[k] = place->second.transform * p;
  }
  return corners;
}

}  // namespace gatelight::renderer
