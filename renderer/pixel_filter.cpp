#include "renderer/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gatelight::renderer {

namespace {

/// x in [-1, 1] over the full width.
double profile(PixelFilter filter, double x) {
  switch (filter) {
    case PixelFilter::box:
      return 1.0;
    case PixelFilter::tent:
      return 1.0 - std::abs(x);
    case PixelFilter::gaussian:
      // Three standard deviations at the edge, shifted down to end at zero.
      return std::exp(-4.5 * x * x) - std::exp(-4.5);
    case PixelFilter::blackman_harris: {
      const double a = M_PI * (x + 1.0);
      return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2.0 * a) - 0.01168 * std::cos(3.0 * a);
    }
  }
  return 0.0;
}

float default_width(PixelFilter filter) {
  switch (filter) {
    case PixelFilter::box:
      return 1.0f;
    case PixelFilter::tent:
      return 2.0f;
    case PixelFilter::gaussian:
    case PixelFilter::blackman_harris:
      break;
  }
  return 3.0f;
}

}  // namespace

FilterSampler::FilterSampler(PixelFilter filter, float width)
    : width_(width > 0.0f ? width : default_width(filter)) {
  constexpr int kFine = 16384;
  std::vector<double> cumulative(kFine + 1, 0.0);
  for (int i = 0; i < kFine; ++i) {
    cumulative[static_cast<std::size_t>(i) + 1] =
        cumulative[static_cast<std::size_t>(i)] +
        std::max(0.0, profile(filter, (2.0 * i + 1.0) / kFine - 1.0));
  }
  const double total = cumulative.back();
  std::size_t j = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double target = total * i / kSteps;
    while (j + 1 < kFine && cumulative[j + 1] < target) ++j;
    const double step = cumulative[j + 1] - cumulative[j];
    const double fraction = step > 0.0 ? std::clamp((target - cumulative[j]) / step, 0.0, 1.0) : 0.0;
    inverse_[static_cast<std::size_t>(i)] =
        static_cast<float>((static_cast<double>(j) + fraction) / kFine - 0.5) * width_;
  }
}

float FilterSampler::sample_1d(float u) const {
  const float x = u * kSteps;
  const int i = std::min(static_cast<int>(x), kSteps - 1);
  const float w = x - static_cast<float>(i);
  return inverse_[static_cast<std::size_t>(i)] * (1.0f - w) + inverse_[static_cast<std::size_t>(i) + 1] * w;
}

}  // namespace gatelight::renderer
