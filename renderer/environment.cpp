#include "renderer/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/environment_picture.h"
#include "renderer/image_read.h"
#include "renderer/warp.h"

namespace gatelight::renderer {
namespace {

/// Largest radiance that is kept: sums of a whole picture and products with a throughput stay finite.
constexpr float kLargest = 1e30f;

float usable(float value) {
  return value > 0.0f && std::isfinite(value) ? std::min(value, kLargest) : 0.0f;
}

std::unique_ptr<const EnvironmentPicture> load(const EnvironmentOptions& options) {
  const Picture picture = read_image(options.file);
  const Layer& layer = picture.layers.front();
  const std::size_t channels = layer.channels.size();
  const std::size_t count =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  std::vector<Color> texels(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* value = layer.values.data() + i * channels;
    for (std::size_t c = 0; c < 3; ++c) {
      // Grey, with or without alpha, fills all three.
      texels[i][static_cast<Eigen::Index>(c)] = usable(usable(value[channels < 3 ? 0 : c]) * options.scale);
    }
  }
  return std::make_unique<const EnvironmentPicture>(picture.width, picture.height, std::move(texels));
}

}  // namespace

Environment::Environment(const EnvironmentOptions& options) {
  if (!(options.scale >= 0.0f) || !std::isfinite(options.scale)) {
    throw std::runtime_error(
        fmt::format("the environment's scale is {}; it must be finite and not negative", options.scale));
  }
  if (!std::isfinite(options.rotation_degrees)) {
    throw std::runtime_error("the environment's rotation is not a finite number of degrees");
  }
  const double angle = static_cast<double>(options.rotation_degrees) * M_PI / 180.0;
  cos_ = static_cast<float>(std::cos(angle));
  sin_ = static_cast<float>(std::sin(angle));
  if (options.file.empty()) {
    for (Eigen::Index c = 0; c < 3; ++c) mean_[c] = usable(usable(options.constant[c]) * options.scale);
  } else {
    picture_ = load(options);
    mean_ = picture_->mean();
  }
}

Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;

Color Environment::radiance(const Vec3& direction) const {
  return picture_ ? picture_->radiance(to_picture(direction)) : mean_;
}

Color Environment::radiance(const Vec3& direction, float cone_angle) const {
  return picture_ ? picture_->radiance(to_picture(direction), cone_angle) : mean_;
}

EnvironmentSample Environment::sample(const Vec2& u) const {
  if (black()) return {};
  if (!picture_) return {sample_uniform_sphere(u), mean_, pdf_uniform_sphere()};
  EnvironmentSample sample = picture_->sample(u);
  sample.wi = to_world(sample.wi);
  return sample;
}

float Environment::pdf(const Vec3& direction) const {
  if (black()) return 0.0f;
  return picture_ ? picture_->pdf(to_picture(direction)) : pdf_uniform_sphere();
}

std::size_t Environment::bytes() const {
  return picture_ ? picture_->bytes() : 0;
}

}  // namespace gatelight::renderer
