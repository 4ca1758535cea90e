#pragma once
// The sun as a disc of equal radiance, infinitely far away.

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "renderer/sampling/warp.h"

namespace gatelight::renderer {

/// A sun too small for a disc.
struct DistantSun {
  Vec3 direction{0.0f, 1.0f, 0.0f};    ///< unit, to the sun
  Color irradiance{0.0f, 0.0f, 0.0f};  ///< on a plane that faces it
};

/// A cone of directions around the sun's centre. The part below y = 0 is hidden by the earth.
class SunDisc {
 public:
  /// `direction` is unit; `radius` is the angle from the centre to the edge, in radians, above zero. The disc
  /// as a whole, also its hidden part, would have this irradiance on a plane that faces it.
  SunDisc(const Vec3& direction, float radius, const Color& irradiance)
      : direction_(direction), sin_radius_(std::sin(radius)) {
    const float half = std::sin(0.5f * radius);
    height_ = 2.0f * half * half;
    // The integral of the cosine over the cone is pi sin^2(radius).
    radiance_ = irradiance / (kPi * sin_radius_ * sin_radius_);
  }

  /// Whether the cone contains a direction. The squared chord of two unit vectors is 2 (1 - cosine), without
  /// the cosine's loss of digits near 1.
  bool holds(const Vec3& d) const { return (d - direction_).squaredNorm() <= 2.0f * height_; }

  Color radiance(const Vec3& d) const { return d.y() >= 0.0f && holds(d) ? radiance_ : Color::Zero(); }

  /// Uniform by solid angle over the whole cone.
  Vec3 sample(const Vec2& u) const {
    const float down = u.x() * height_;  // 1 - cosine
    const float sine = std::sqrt(std::max(0.0f, down * (2.0f - down)));
    const float phi = 2.0f * kPi * u.y();
    const Vec3 local(sine * std::cos(phi), sine * std::sin(phi), 1.0f - down);
    return Basis(direction_).to_world(local).normalized();
  }
  float pdf(const Vec3& d) const { return holds(d) ? 1.0f / solid_angle() : 0.0f; }

  float solid_angle() const { return 2.0f * kPi * height_; }
  /// Whether some of the disc may be above the horizon of a plane with this unit normal.
  bool above(const Vec3& n) const { return n.dot(direction_) > -sin_radius_; }
  /// The mean radiance over the sphere of directions, as if no part were hidden.
  Color mean() const { return radiance_ * (solid_angle() / (4.0f * kPi)); }

 private:
  Vec3 direction_;
  float sin_radius_;
  float height_;  ///< 1 - cos(radius)
  Color radiance_{0.0f, 0.0f, 0.0f};
};

}  // namespace gatelight::renderer
