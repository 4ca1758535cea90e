#pragma once
// Light from infinitely far away: a constant, or a latitude-longitude picture with importance sampling.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "renderer/light/environment_sample.h"
#include "renderer/settings/environment_options.h"
#include "scene/math.h"

namespace gatelight::renderer {

using scene::Color;
using scene::Vec2;
using scene::Vec3;

class EnvironmentPicture;

/// The centre of the picture is in the direction -z, +x is to its right, and +y is up (the convention of most
/// viewers). Infinite values become the largest finite value of the picture, at least 65504 (the largest
/// half). NaN and negative values become zero. Thread-safe after construction.
class Environment {
 public:
  /// Throws std::runtime_error that names the file when it cannot be read.
  explicit Environment(const EnvironmentOptions& options);
  ~Environment();
  Environment(Environment&&) noexcept;

  Color radiance(const Vec3& direction) const;
  /// The same, filtered for a ray cone with this full angle in radians.
  Color radiance(const Vec3& direction, float cone_angle) const;
  /// A constant environment is sampled uniformly over the sphere, a picture by its luminance.
  EnvironmentSample sample(const Vec2& u) const;
  float pdf(const Vec3& direction) const;
  /// The mean radiance over the sphere; texels are weighted by their solid angle.
  Color mean() const { return mean_; }
  bool black() const { return (mean_ == 0.0f).all(); }
  /// Whether the radiance is the same in all directions. Then sampling by the receiver's cosine is better.
  bool constant() const { return picture_ == nullptr; }
  std::size_t bytes() const;
  /// One line that counts the values of the picture that are negative or not finite; empty if there are none.
  const std::string& warning() const { return warning_; }

 private:
  Vec3 to_picture(const Vec3& world) const {
    return {cos_ * world.x() - sin_ * world.z(), world.y(), sin_ * world.x() + cos_ * world.z()};
  }
  Vec3 to_world(const Vec3& picture) const {
    return {cos_ * picture.x() + sin_ * picture.z(), picture.y(), cos_ * picture.z() - sin_ * picture.x()};
  }

  std::unique_ptr<const EnvironmentPicture> picture_;
  std::string warning_;
  Color mean_{0.0f, 0.0f, 0.0f};
  float cos_ = 1.0f;  ///< cosine and sine of the rotation
  float sin_ = 0.0f;
};

}  // namespace gatelight::renderer
