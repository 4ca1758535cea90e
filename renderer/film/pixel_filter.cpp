#include "renderer/film/pixel_filter.h"

#include <algorithm>
#include <cmath>

#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

double filter_value(PixelFilter filter, double x) {
  switch (filter) {
    case PixelFilter::box:
      return 1.0;
    case PixelFilter::tent:
      return 1.0 - std::abs(x);
    case PixelFilter::gaussian:
      // The edge is at three standard deviations, and the curve is shifted down to end at zero.
      return std::exp(-4.5 * x * x) - std::exp(-4.5);
    case PixelFilter::blackman_harris: {
      const double a = M_PI * (x + 1.0);
      return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2.0 * a) - 0.01168 * std::cos(3.0 * a);
    }
  }
  return 0.0;
}

FilterSampler::FilterSampler(PixelFilter filter, float width) : width_(resolve_filter_width(filter, width)) {
  std::array<double, kBins + 1> sum{};
  for (std::size_t i = 0; i < kBins; ++i) {
    sum[i + 1] =
        sum[i] + std::max(0.0, filter_value(filter, (2.0 * static_cast<double>(i) + 1.0) / kBins - 1.0));
  }
  for (std::size_t i = 0; i <= kBins; ++i) cumulative_[i] = static_cast<float>(sum[i] / sum[kBins]);
  std::size_t edge = 1;
  for (std::size_t i = 0; i < kGuides; ++i) {
    while (edge < kBins && cumulative_[edge] <= static_cast<float>(i) / kGuides) ++edge;
    guide_[i] = static_cast<std::uint16_t>(edge);
  }
}

float FilterSampler::sample_1d(float u) const {
  // A table of the inverse would be wrong at the tails, where the inverse is steep. So guides only shorten
  // the search (Chen and Asau 1974). Where the filter is not near zero, at most one edge lies between two
  // guides. That step has no branch, because it could not be predicted.
  std::size_t above = guide_[static_cast<std::size_t>(u * kGuides)];
  above += cumulative_[above] <= u ? 1 : 0;
  while (cumulative_[above] <= u) ++above;
  const std::size_t bin = above - 1;
  const float mass = cumulative_[bin + 1] - cumulative_[bin];
  const float within = mass > 0.0f ? std::clamp((u - cumulative_[bin]) / mass, 0.0f, 1.0f) : 0.5f;
  return ((static_cast<float>(bin) + within) / kBins - 0.5f) * width_;
}

}  // namespace gatelight::renderer
