#include "scene/shutter.h"

namespace gatelight::scene {

int parts_of_turn(double turn, int intervals) {
  constexpr double kTurn = 0.1;
  const int most = std::max(1, kMaxShutterIntervals / intervals);
  int parts = 1;
  while (turn > kTurn * parts && parts < most) parts = std::min(2 * parts, most);
  return parts;
}

float time_by_clock(const std::vector<float>& clock, float seen) {
  if (clock.empty()) return seen;
  const auto after = std::upper_bound(clock.begin() + 1, clock.end() - 1, seen);
  const auto before = after - 1;
  return (static_cast<float>(before - clock.begin()) + (seen - *before) / (*after - *before)) /
         static_cast<float>(clock.size() - 1);
}

float clock_at(const std::vector<float>& clock, float time) {
  if (clock.empty()) return time;
  const StatesAround<float> around = states_around(clock, time);
  return between(around.before, around.after, around.fraction);
}

Affine transform_at(const std::vector<Affine>& states, float time) {
  const StatesAround<Affine> around = states_around(states, time);
  Affine transform;
  transform.matrix() = between(around.before.matrix(), around.after.matrix(), around.fraction);
  return transform;
}

Camera camera_at(const std::vector<Camera>& states, float time) {
  const StatesAround<Camera> around = states_around(states, time);
  const auto mix = [&](float Camera::*member) {
    return between(around.before.*member, around.after.*member, around.fraction);
  };
  Camera camera = around.before;
  camera.transform.matrix() =
      between(around.before.transform.matrix(), around.after.transform.matrix(), around.fraction);
  camera.vertical_fov = mix(&Camera::vertical_fov);
  camera.half_height = mix(&Camera::half_height);
  camera.half_width = mix(&Camera::half_width);
  return camera;
}

LightPlace light_at(const std::vector<LightPlace>& states, float time) {
  const StatesAround<LightPlace> around = states_around(states, time);
  const auto mix = [&](Vec3 LightPlace::*member) {
    return between<Vec3>(around.before.*member, around.after.*member, around.fraction);
  };
  LightPlace place{mix(&LightPlace::position), mix(&LightPlace::direction), mix(&LightPlace::side)};
  place.direction.stableNormalize();
  place.side = (place.side - place.direction * place.direction.dot(place.side)).stableNormalized();
  return place;
}

bool is_blurred(const Scene& scene, std::size_t instance) {
  return count_states(scene, instance) > 0;
}

std::size_t count_states(const Scene& scene, std::size_t instance) {
  const ShutterMotion& shutter = scene.shutter;
  if (!shutter.instances) return 0;
  return std::max(shutter.transforms[instance].size(),
                  shutter.vertices[static_cast<std::size_t>(scene.instances[instance].mesh)].size());
}

std::array<Vec3, 3> world_triangle_at(const Scene& scene, std::size_t instance, std::uint32_t primitive,
                                      float time) {
  const Instance& placed = scene.instances[instance];
  if (!is_blurred(scene, instance)) return world_triangle(scene, placed, primitive);
  const std::vector<Affine>& transforms = scene.shutter.transforms[instance];
  const std::vector<DeformedVertices>& vertices =
      scene.shutter.vertices[static_cast<std::size_t>(placed.mesh)];
  const Mesh& mesh = scene.mesh_of(placed);
  const Affine transform = transforms.empty() ? placed.transform : transform_at(transforms, time);
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t corner = mesh.triangles[primitive][k];
    corners[k] =
        transform * (vertices.empty() ? mesh.positions[corner]
                                      : attribute_at(vertices, time, corner, &DeformedVertices::positions));
  }
  return corners;
}

}  // namespace gatelight::scene
