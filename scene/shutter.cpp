#include "scene/shutter.h"

namespace gatelight::scene {

Affine transform_at(const std::vector<Affine>& states, float time) {
  const StatesAround<Affine> around = states_around(states, time);
  Affine transform;
  transform.matrix() = between(around.before.matrix(), around.after.matrix(), around.fraction);
  return transform;
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
  const ShutterMotion& shutter = scene.shutter;
  if (!shutter.instances) return false;
  return !shutter.transforms[instance].empty() ||
         !shutter.vertices[static_cast<std::size_t>(scene.instances[instance].mesh)].empty();
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
