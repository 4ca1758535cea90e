#pragma once
// Point, spot and directional lights of KHR_lights_punctual.

#include <algorithm>
#include <cmath>

#include "scene/scene.h"

namespace gatelight::renderer {

/// The extension's recommended window: 1 near the light, 0 from its range on, and smooth between them.
inline float range_window(float distance, float range) {
  if (!(range < kInfinity)) return 1.0f;
  const float x = distance / range;
  const float x2 = x * x;
  return std::clamp(1.0f - x2 * x2, 0.0f, 1.0f);
}

/// The extension's falloff between the cones: the square of a ramp that is linear in the cosine. `cos_angle`
/// is between the light's direction and the direction from the light to the point.
inline float spot_falloff(const scene::PunctualLight& light, float cos_angle) {
  const float width = std::max(0.001f, light.cos_inner - light.cos_outer);
  const float x = std::clamp((cos_angle - light.cos_outer) / width, 0.0f, 1.0f);
  return x * x;
}

/// The share of the greatest intensity that a light with a profile sends to a point. `wi` points to the
/// light.
inline float profile_share(const scene::PunctualLight& light, const Vec3& wi) {
  const Vec3 up = light.side.cross(light.direction);
  return light.profile->relative({-wi.dot(light.side), -wi.dot(up), wi.dot(light.direction)});
}

/// The irradiance of a point or spot light on a plane that faces it at `distance`. `wi` points to the light.
inline Color punctual_irradiance(const scene::PunctualLight& light, const Vec3& wi, float distance) {
  float factor = range_window(distance, light.range) / (distance * distance);
  if (light.type == scene::LightType::spot) factor *= spot_falloff(light, -wi.dot(light.direction));
  if (light.profile) factor *= profile_share(light, wi);
  return light.intensity * factor;
}

}  // namespace gatelight::renderer
