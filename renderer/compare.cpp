#include "renderer/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/srgb.h"

namespace gatelight::renderer {
namespace {

using Rgb = std::array<double, 3>;

/// The colours of a picture, whatever the order of its channels.
class Beauty {
 public:
  explicit Beauty(const NamedPicture& named) {
    if (named.picture.layers.empty() || named.picture.layers.front().channels.empty()) {
      throw CompareError(fmt::format("'{}' has no layer to compare", named.name));
    }
    layer_ = &named.picture.layers.front();
    const std::vector<std::string>& channels = layer_->channels;
    const std::array<const char*, 3> names{"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto found = std::find(channels.begin(), channels.end(), names[c]);
      if (found != channels.end()) {
        index_[c] = static_cast<std::size_t>(found - channels.begin());
      } else if (channels.front() == "Y") {
        index_[c] = 0;
      } else {
        throw CompareError(
            fmt::format("'{}' has no beauty layer: channel {} is missing", named.name, names[c]));
      }
    }
  }

  Rgb at(std::size_t pixel) const {
    const float* values = layer_->values.data() + pixel * layer_->channels.size();
    return {values[index_[0]], values[index_[1]], values[index_[2]]};
  }

 private:
  const Layer* layer_ = nullptr;
  std::array<std::size_t, 3> index_{};
};

bool finite(const Rgb& color) {
  return std::isfinite(color[0]) && std::isfinite(color[1]) && std::isfinite(color[2]);
}

void require_same_size(const NamedPicture& a, const NamedPicture& b) {
  if (a.picture.width == b.picture.width && a.picture.height == b.picture.height) return;
  throw CompareError(fmt::format("the pictures differ in size: '{}' has {}x{} pixels, '{}' has {}x{}", a.name,
                                 a.picture.width, a.picture.height, b.name, b.picture.width,
                                 b.picture.height));
}

std::size_t pixel_count(const Picture& picture) {
  return static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
}

double relative_squared(double reference, double difference) {
  return difference * difference / (reference * reference + kRelMseEpsilon);
}

struct Stop {
  float at;
  std::array<float, 3> display;
};
constexpr std::array<Stop, 5> kRamp{{{0.0f, {0.0f, 0.0f, 0.0f}},
                                     {0.1f, {0.35f, 0.05f, 0.5f}},
                                     {0.25f, {0.85f, 0.15f, 0.2f}},
                                     {0.5f, {1.0f, 0.8f, 0.1f}},
                                     {1.0f, {1.0f, 1.0f, 1.0f}}}};

std::array<float, 3> ramp(float x) {
  for (std::size_t i = 1; i < kRamp.size(); ++i) {
    if (x > kRamp[i].at) continue;
    const float t = (x - kRamp[i - 1].at) / (kRamp[i].at - kRamp[i - 1].at);
    std::array<float, 3> color{};
    for (std::size_t c = 0; c < 3; ++c) {
      color[c] = kRamp[i - 1].display[c] + t * (kRamp[i].display[c] - kRamp[i - 1].display[c]);
    }
    return color;
  }
  return kRamp.back().display;
}

}  // namespace

ErrorMetrics compare_pictures(const NamedPicture& reference, const NamedPicture& test) {
  require_same_size(reference, test);
  const Beauty reference_beauty(reference);
  const Beauty test_beauty(test);
  ErrorMetrics metrics;
  const std::size_t pixels = pixel_count(reference.picture);
  for (std::size_t p = 0; p < pixels; ++p) {
    const Rgb r = reference_beauty.at(p);
    const Rgb t = test_beauty.at(p);
    const bool reference_finite = finite(r);
    const bool test_finite = finite(t);
    metrics.nonfinite_reference += reference_finite ? 0 : 1;
    metrics.nonfinite_test += test_finite ? 0 : 1;
    if (!reference_finite || !test_finite) continue;
    ++metrics.pixels;
    for (std::size_t c = 0; c < 3; ++c) {
      const double difference = t[c] - r[c];
      metrics.mse += difference * difference;
      metrics.rel_mse += relative_squared(r[c], difference);
      metrics.mean_error += std::abs(difference);
      metrics.mean_difference += difference;
      metrics.max_error = std::max(metrics.max_error, std::abs(difference));
    }
  }
  if (metrics.pixels > 0) {
    const double count = 3.0 * static_cast<double>(metrics.pixels);
    metrics.mse /= count;
    metrics.rel_mse /= count;
    metrics.mean_error /= count;
    metrics.mean_difference /= count;
  }
  metrics.psnr = metrics.mse > 0.0 ? 10.0 * std::log10(kPsnrPeak * kPsnrPeak / metrics.mse)
                                   : std::numeric_limits<double>::infinity();
  return metrics;
}

Picture error_map(const NamedPicture& reference, const NamedPicture& test) {
  require_same_size(reference, test);
  const Beauty reference_beauty(reference);
  const Beauty test_beauty(test);
  const std::size_t pixels = pixel_count(reference.picture);
  Picture map{.width = reference.picture.width, .height = reference.picture.height};
  Layer layer{.channels = {"R", "G", "B"}};
  layer.values.resize(3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    const Rgb r = reference_beauty.at(p);
    const Rgb t = test_beauty.at(p);
    std::array<float, 3> display{0.0f, 1.0f, 0.0f};
    if (finite(r) && finite(t)) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 3; ++c) sum += relative_squared(r[c], t[c] - r[c]);
      display = ramp(static_cast<float>(std::sqrt(sum / 3.0)));
    }
    for (std::size_t c = 0; c < 3; ++c) layer.values[3 * p + c] = srgb_to_linear(display[c]);
  }
  map.layers.push_back(std::move(layer));
  return map;
}

}  // namespace gatelight::renderer
