#include "renderer/light/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "base/image/claimed_size.h"
#include "renderer/image/color_channels.h"
#include "renderer/image/image_read.h"
#include "renderer/light/clear_sky.h"
#include "renderer/light/cube_picture.h"
#include "renderer/light/soft_sky.h"
#include "renderer/sampling/warp.h"

namespace gatelight::renderer {
namespace {

/// Negative values and NaN become 0.
float usable(double value) {
  return value > 0.0 ? static_cast<float>(std::min(value, static_cast<double>(kLargestRadiance))) : 0.0f;
}

float scaled(float value, float scale) {
  return usable(static_cast<double>(usable(value)) * static_cast<double>(scale));
}

/// Repairs the values of a picture and counts the invalid ones.
class Repair {
 public:
  explicit Repair(std::span<const float> values) {
    for (const float value : values) {
      if (std::isfinite(value)) greatest_ = std::max(greatest_, value);
    }
  }

  float operator()(float value) {
    infinite_ += value == kInfinity ? 1 : 0;
    no_light_ += value >= 0.0f ? 0 : 1;
    return value == kInfinity ? greatest_ : value;
  }

  std::string warning(const std::string& file) const {
    if (infinite_ + no_light_ == 0) return "";
    return fmt::format(
        "environment '{}': {} values are infinite and taken as {}, {} negative or NaN and taken as 0", file,
        infinite_, greatest_, no_light_);
  }

 private:
  float greatest_ = 65504.0f;  ///< half precision stores anything larger as infinity
  std::size_t infinite_ = 0;
  std::size_t no_light_ = 0;
};

/// Checks the size of the full picture. An EXR may store only a part of it; the rest is black.
void check_full_size(const Picture& picture, const std::string& file) {
  try {
    check_claimed_size(picture.full_width, picture.full_height, 3, file);
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("cannot read '{}': display window: {}", file, error.what()));
  }
}

EnvironmentPicture load(const EnvironmentOptions& options, std::string& warning) {
  Picture picture = read_image(options.file);
  const Layer& layer = picture.layers.front();
  const auto color = color_channels(layer);
  if (!color) {
    throw InputError(
        fmt::format("cannot use '{}' as environment: it has the {}", options.file, describe_channels(layer)));
  }
  if (picture.full_width <= 0) {
    picture.full_width = picture.width;
    picture.full_height = picture.height;
  }
  check_full_size(picture, options.file);
  const auto texel = [](int width, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  std::vector<Color> texels(texel(picture.full_width, 0, picture.full_height), Color::Zero());
  Repair repaired(layer.values);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::int64_t full_x = std::int64_t{picture.x0} + x;
      const std::int64_t full_y = std::int64_t{picture.y0} + y;
      if (full_x < 0 || full_y < 0 || full_x >= picture.full_width || full_y >= picture.full_height) continue;
      const float* value = layer.values.data() + texel(picture.width, x, y) * layer.channels.size();
      Color& target = texels[texel(picture.full_width, static_cast<int>(full_x), static_cast<int>(full_y))];
      for (std::size_t c = 0; c < 3; ++c) {
        target[static_cast<Eigen::Index>(c)] = scaled(repaired(value[(*color)[c]]), options.scale);
      }
    }
  }
  warning = repaired.warning(options.file);
  return {picture.full_width, picture.full_height, std::move(texels)};
}

}  // namespace

Environment::Environment(const EnvironmentOptions& options, const scene::ImageBasedLight* of_scene) {
  if (!(options.scale >= 0.0f) || !std::isfinite(options.scale)) {
    throw InputError(
        fmt::format("the environment's scale is {}; it must be finite and not negative", options.scale));
  }
  if (!std::isfinite(options.rotation_degrees)) {
    throw InputError("the environment's rotation is not a finite number of degrees");
  }
  if (options.sky && (options.automatic || !options.file.empty() || (options.constant != 0.0f).any()))
    throw InputError("`sky` and `environment` exclude each other, expected one of them");
  double degrees = static_cast<double>(options.rotation_degrees);
  std::optional<ClearSky> sky;
  if (options.sky) {
    sky = make_clear_sky(*options.sky, options.scale);
    degrees -= sky->sun_azimuth_degrees;  // the sun of its picture is at the centre
  }
  const double angle = degrees * M_PI / 180.0;
  cos_ = static_cast<float>(std::cos(angle));
  sin_ = static_cast<float>(std::sin(angle));
  if (sky) {
    picture_ = std::move(sky->picture);
    mean_ = picture_->mean();
    if (!(sky->sun_irradiance > 0.0f).any()) {
      // At night there is no sun.
    } else if (sky->sun_radius > 0.0f) {
      disc_.emplace(sky->to_sun, sky->sun_radius, sky->sun_irradiance);
      mean_ += disc_->mean();
    } else {
      distant_sun_ = {to_world(sky->to_sun), sky->sun_irradiance};
    }
  } else if (options.automatic) {
    picture_ = of_scene ? make_cube_picture(*of_scene, options.scale) : make_soft_sky(options.scale);
    mean_ = picture_->mean();
  } else if (options.file.empty()) {
    for (Eigen::Index c = 0; c < 3; ++c) mean_[c] = scaled(options.constant[c], options.scale);
  } else {
    picture_ = load(options, warning_);
    mean_ = picture_->mean();
  }
}

Color Environment::radiance(const Vec3& direction, float cone_angle) const {
  if (!picture_) return mean_;
  const Vec3 d = to_picture(direction);
  const Color radiance = picture_->radiance(d, cone_angle);
  return disc_ ? Color(radiance + disc_->radiance(d)) : radiance;
}

EnvironmentSample Environment::sample(const Vec2& u, const Vec3& n) const {
  if (black()) return {};
  if (!picture_) return {sample_uniform_sphere(u), mean_, pdf_uniform_sphere()};
  EnvironmentSample sample;
  if (disc_) {
    const float share = disc_share(to_picture(n));
    if (u.x() < share) {
      const Vec3 d = disc_->sample({u.x() / share, u.y()});
      sample = {d, picture_->radiance(d),
                1.0f / disc_->solid_angle() * share + picture_->pdf(d) * (1.0f - share)};
    } else {
      const float rest = std::min((u.x() - share) / (1.0f - share), 0x1.fffffep-1f);
      sample = picture_->sample({rest, u.y()});
      sample.pdf = sample.pdf * (1.0f - share) + disc_->pdf(sample.wi) * share;
    }
    sample.radiance += disc_->radiance(sample.wi);
  } else {
    sample = picture_->sample(u);
  }
  sample.wi = to_world(sample.wi);
  return sample;
}

float Environment::pdf(const Vec3& direction, const Vec3& n) const {
  if (black()) return 0.0f;
  if (!picture_) return pdf_uniform_sphere();
  const Vec3 d = to_picture(direction);
  const float share = disc_share(to_picture(n));
  const float pdf = picture_->pdf(d) * (1.0f - share);
  return share > 0.0f ? pdf + disc_->pdf(d) * share : pdf;
}

}  // namespace gatelight::renderer
