#pragma once
// Materials and lights that many small scenes have.

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

/// A sun whose light travels in this direction.
inline scene::PunctualLight sun(const Vec3& direction, const Color& intensity = Color::Ones()) {
  return {.type = scene::LightType::directional, .intensity = intensity, .direction = direction.normalized()};
}

inline scene::PunctualLight point_light(const Vec3& position, const Color& intensity) {
  return {.intensity = intensity, .position = position};
}

}  // namespace gatelight::testing
