#include "renderer/transport/view_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

namespace {

/// Whether some vertex lies in the picture.
bool shows_a_vertex(const scene::Scene& scene, const Camera& camera, int width, int height) {
  for (const scene::Instance& instance : scene.instances) {
    if (instance.hidden || !(instance.visibility.rays & scene::kCameraRays)) continue;
    for (const Vec3& p : scene.mesh_of(instance).positions) {
      const std::optional<Vec2> at = camera.pixel_of(instance.transform * p);
      if (at && at->x() >= 0.0f && at->y() >= 0.0f && at->x() <= static_cast<float>(width) &&
          at->y() <= static_cast<float>(height))
        return true;
    }
  }
  return false;
}

}  // namespace

std::string view_warning(const World& world, const Camera& camera, int width, int height) {
  if (scene::count_triangles(world.scene) == 0)
    return fmt::format("{}: there are no triangles to show", world.scene.path);
  constexpr int kGrid = 32;
  constexpr double kAll = kGrid * kGrid;
  constexpr double kMaxBacks = 0.75;
  std::vector<Ray> rays;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      rays.push_back(camera
                         .ray((static_cast<float>(x) + 0.5f) / kGrid * static_cast<float>(width),
                              (static_cast<float>(y) + 0.5f) / kGrid * static_cast<float>(height))
                         .ray);
    }
  }
  std::vector<Hit> hits(rays.size());
  world.accel.intersect(rays, hits, true);
  int backs = 0, missed = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit& hit = hits[i];
    if (!hit) {
      missed += 1;
      continue;
    }
    const scene::Instance& instance = world.scene.instances[hit.instance];
    const scene::Material& material = world.scene.material_of(instance);
    if (material.double_sided || material.culled || material.transmits()) continue;
    const Vec3 normal = scene::world_normal(world.scene, instance, hit.primitive);
    backs += normal.dot(rays[i].direction) > 0.0f ? 1 : 0;
  }
  if (missed == static_cast<int>(rays.size())) {
    if (shows_a_vertex(world.scene, camera, width, height)) return "";
    return fmt::format("{}: the camera sees nothing: 100 % of its rays meet no surface", world.scene.path);
  }
  if (backs >= kMaxBacks * kAll) {
    return fmt::format("{}: the camera may stand inside an object: {:.0f} % of its rays meet back faces",
                       world.scene.path, 100.0 * backs / kAll);
  }
  return "";
}

float distance_in_the_middle(const World& world, const Camera& camera, int width, int height) {
  const auto [ray, cone, begin] =
      camera.ray(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height));
  Hit hit;
  world.accel.intersect({&ray, 1}, {&hit, 1}, true);
  if (hit) return begin + hit.t;
  if (world.scene.bounds.isEmpty()) return 1.0f;
  const float along = (world.scene.bounds.center() - ray.origin).dot(ray.direction);
  return along > 0.0f ? along : world.scene.bounds.diagonal().norm();
}

}  // namespace gatelight::renderer
