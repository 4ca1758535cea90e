#pragma once
// The pixel filter by importance sampling: every sample has weight one and counts for one pixel
// only.

#include <array>
#include <cstdint>

#include "base/math.h"
#include "renderer/settings/enums.h"

namespace gatelight::renderer {

/// The filter's value at x in [-1, 1] over its full width; not normalized.
double filter_value(PixelFilter filter, double x);

class FilterSampler {
 public:
  /// `width` is as resolve_filter_width() takes it.
  FilterSampler(PixelFilter filter, float width);

  /// The offset from the pixel's centre in pixels. It is distributed as the filter, which is not negative,
  /// when `u` is uniform.
  Vec2 sample(const Vec2& u) const { return {sample_1d(u.x()), sample_1d(u.y())}; }
  float width() const { return width_; }

 private:
  static constexpr int kBins = 1000;
  static constexpr int kGuides = 4096;  ///< a power of two, so that u * kGuides is exact
  float sample_1d(float u) const;

  float width_;
  std::array<float, kBins + 1> cumulative_{};   ///< cumulative distribution at the edges of equal bins
  std::array<std::uint16_t, kGuides> guide_{};  ///< the first edge above i / kGuides, where a search starts
};

}  // namespace gatelight::renderer
