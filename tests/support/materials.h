#pragma once
// Materials, lights and floors that many small scenes have.

#include "tests/support/scene_builder.h"

namespace gatelight::testing {

/// A grey smooth metal.
inline scene::Material mirror(float reflectance = 0.9f) {
  scene::Material m;
  m.base_color = Color::Constant(reflectance);
  m.roughness = 0.0f;
  return m;
}

/// Glass with an inside.
inline scene::Material solid_glass(float ior = 1.5f, float roughness = 0.0f) {
  scene::Material m = SceneBuilder::clear_glass();
  m.roughness = roughness;
  m.ior = ior;
  m.thickness = 1.0f;
  return m;
}

/// A level square around the y axis that faces up.
inline scene::Mesh& add_floor(SceneBuilder& builder, const scene::Material& material, float half,
                              float height = 0.0f) {
  return builder.quad(builder.material(material), Vec3(-half, height, half), Vec3(2.0f * half, 0, 0),
                      Vec3(0, 0, -2.0f * half));
}

/// A sun whose light travels in this direction.
inline scene::PunctualLight sun(const Vec3& direction, const Color& intensity = Color::Ones()) {
  return {.type = scene::LightType::directional, .intensity = intensity, .direction = direction.normalized()};
}

inline scene::PunctualLight point_light(const Vec3& position, const Color& intensity) {
  return {.intensity = intensity, .position = position};
}

}  // namespace gatelight::testing
