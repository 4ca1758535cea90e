#pragma once
// The phase function of Henyey and Greenstein 1941, "Diffuse radiation in the galaxy".

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace gatelight::renderer {

/// The phase function, per solid angle, for light that changes its direction by an angle of this cosine.
/// `g` in (-1, 1) is the mean cosine: positive forward. It is also the density of sample_phase().
inline float phase(float g, float cosine) {
  // The square of the distance from (g, 0) to the unit vector: without cancellation where both are forward.
  const float along = 1.0f - std::abs(g),
              square = along * along + 2.0f * std::abs(g) * (g < 0.0f ? 1.0f + cosine : 1.0f - cosine);
  return 0.25f * kInvPi * (1.0f - g * g) / (square * std::sqrt(square));
}

/// A direction by the phase function, for light that travels along `direction`, a unit vector. `u` is in
/// [0, 1).
inline Vec3 sample_phase(float g, const Vec3& direction, const Vec2& u) {
  float cosine = 1.0f - 2.0f * u.x();
  if (std::abs(g) > 1e-3f) {
    const float s = (1.0f - g * g) / (1.0f - g + 2.0f * g * (1.0f - u.x()));
    cosine = std::clamp((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
  }
  const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), angle = 2.0f * kPi * u.y();
  const Vec3 x = any_perpendicular(direction), y = direction.cross(x);
  return (cosine * direction + sine * (std::cos(angle) * x + std::sin(angle) * y)).normalized();
}

}  // namespace gatelight::renderer
