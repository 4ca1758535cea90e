#pragma once
// Light from infinitely far away: a constant, or a latitude-longitude picture with importance sampling, and
// the disc of a sun in front of it.

#include <optional>
#include <string>

#include "renderer/light/environment_picture.h"
#include "renderer/light/sun_disc.h"
#include "renderer/settings/environment_options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The centre of the picture is in the direction -z, +x is to its right, and +y is up (the convention of most
/// viewers). Infinite values become the largest finite value of the picture, at least 65504 (the largest
/// half). NaN and negative values become zero. Thread-safe after construction.
class Environment {
 public:
  /// Throws InputError that names the file when it cannot be read.
  /// `of_scene` is the automatic environment; without it that is the soft sky.
  explicit Environment(const EnvironmentOptions& options, const scene::ImageBasedLight* of_scene = nullptr);

  /// Filtered for a ray cone with this full angle in radians; 0 means no filter.
  Color radiance(const Vec3& direction, float cone_angle = 0.0f) const;
  /// A constant environment is sampled uniformly over the sphere, a picture by its luminance. A sun's disc
  /// that is not wholly below the horizon of `n` gets half of the samples; a zero `n` has no horizon.
  EnvironmentSample sample(const Vec2& u, const Vec3& n = Vec3::Zero()) const;
  /// The pdf of sample() with the same `n`.
  float pdf(const Vec3& direction, const Vec3& n = Vec3::Zero()) const;
  /// The mean radiance over the sphere; texels are weighted by their solid angle.
  Color mean() const { return mean_; }
  bool black() const { return (mean_ == 0.0f).all(); }
  /// Whether the radiance is the same in all directions. Then sampling by the receiver's cosine is better.
  bool constant() const { return !picture_; }
  /// A sun without a size, which is not part of the radiance: its irradiance on a plane that faces it, and
  /// the direction to it. Empty if there is none.
  const std::optional<DistantSun>& distant_sun() const { return distant_sun_; }
  std::size_t bytes() const { return picture_ ? picture_->bytes() : 0; }
  /// One line that counts the values of the picture that are negative or not finite; empty if there are none.
  const std::string& warning() const { return warning_; }

 private:
  /// The probability with which a light sample goes to the disc. `n` is in the picture's frame.
  float disc_share(const Vec3& n) const { return disc_ && (n.isZero(0.0f) || disc_->above(n)) ? 0.5f : 0.0f; }
  Vec3 to_picture(const Vec3& world) const {
    return {cos_ * world.x() - sin_ * world.z(), world.y(), sin_ * world.x() + cos_ * world.z()};
  }
  Vec3 to_world(const Vec3& picture) const {
    return {cos_ * picture.x() + sin_ * picture.z(), picture.y(), cos_ * picture.z() - sin_ * picture.x()};
  }

  std::optional<EnvironmentPicture> picture_;
  std::optional<SunDisc> disc_;            ///< in the picture's frame
  std::optional<DistantSun> distant_sun_;  ///< in the world
  std::string warning_;
  Color mean_{0.0f, 0.0f, 0.0f};
  float cos_ = 1.0f;  ///< cosine and sine of the rotation
  float sin_ = 0.0f;
};

}  // namespace gatelight::renderer
