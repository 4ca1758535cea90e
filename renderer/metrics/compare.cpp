#include "renderer/metrics/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/image/srgb.h"

namespace gatelight::renderer {
namespace {

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
  require_comparable(reference, test);
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
  // Without a pixel the errors are undefined: 0 / 0 gives NaN.
  const double count = 3.0 * static_cast<double>(metrics.pixels);
  metrics.mse /= count;
  metrics.rel_mse /= count;
  metrics.mean_error /= count;
  metrics.mean_difference /= count;
  if (metrics.pixels == 0) metrics.max_error = std::numeric_limits<double>::quiet_NaN();
  metrics.psnr = metrics.mse != 0.0 ? 10.0 * std::log10(kPsnrPeak * kPsnrPeak / metrics.mse)
                                    : std::numeric_limits<double>::infinity();
  return metrics;
}

double squared_bias(const Halves& reference, const Halves& test) {
  for (const NamedPicture* other : {&reference.second, &test.first, &test.second}) {
    require_comparable(reference.first, *other);
  }
  const Beauty reference1(reference.first);
  const Beauty reference2(reference.second);
  const Beauty test1(test.first);
  const Beauty test2(test.second);
  double sum = 0.0;
  std::uint64_t compared = 0;
  const std::size_t pixels = pixel_count(reference.first.picture);
  for (std::size_t p = 0; p < pixels; ++p) {
    const Rgb r1 = reference1.at(p);
    const Rgb r2 = reference2.at(p);
    const Rgb t1 = test1.at(p);
    const Rgb t2 = test2.at(p);
    if (!finite(r1) || !finite(r2) || !finite(t1) || !finite(t2)) continue;
    ++compared;
    for (std::size_t c = 0; c < 3; ++c) {
      const double r = 0.5 * (r1[c] + r2[c]);
      sum += (t1[c] - r1[c]) * (t2[c] - r2[c]) / (r * r + kRelMseEpsilon);
    }
  }
  return sum / (3.0 * static_cast<double>(compared));
}

Picture error_map(const NamedPicture& reference, const NamedPicture& test) {
  require_comparable(reference, test);
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
