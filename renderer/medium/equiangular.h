#pragma once
// Distances along a ray for the light of a lamp that is near it: Kulla and Fajardo 2012, "Importance sampling
// techniques for path tracing in participating media".

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "renderer/medium/scattering_medium.h"

namespace gatelight::renderer {

/// The density of a distance is in proportion to the inverse square of its distance from the lamp, which
/// cancels that of the light: angles at the lamp are uniform.
class EquiangularDistances {
 public:
  /// In a part of a ray, which is finite and not empty.
  EquiangularDistances(const Vec3& origin, const Vec3& direction, const Span& span, const Vec3& lamp)
      : nearest_((lamp - origin).dot(direction)) {
    const float height = (lamp - origin - nearest_ * direction).norm();
    height_ = std::max(height, 1e-6f * (span.length() + std::abs(nearest_)));
    begin_ = std::atan((span.begin - nearest_) / height_);
    angle_ = std::atan((span.end - nearest_) / height_) - begin_;
  }

  /// `u` in [0, 1).
  float sample(float u) const { return nearest_ + height_ * std::tan(begin_ + u * angle_); }
  /// Per metre. 0 for a part that is too short or too far from the lamp for its angle.
  float pdf(float distance) const {
    const float along = distance - nearest_;
    return angle_ > 0.0f ? height_ / (angle_ * (height_ * height_ + along * along)) : 0.0f;
  }

 private:
  float nearest_;  ///< the distance that is nearest to the lamp
  float height_;   ///< of the lamp over the ray, in metres
  float begin_, angle_;
};

}  // namespace gatelight::renderer
