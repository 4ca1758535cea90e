#pragma once
// The reconstruction filter by importance sampling: every sample has weight one, and no sample leaves its
// pixel's sum.

#include <array>
#include <cstdint>

#include "renderer/settings/choices.h"
#include "scene/math.h"

namespace gatelight::renderer {

class FilterSampler {
 public:
  /// width: as resolve_filter_width() takes it.
  FilterSampler(PixelFilter filter, float width);

  /// Offset from the pixel's centre, pixels; distributed as the filter (which is not negative) when u is
  /// uniform.
  scene::Vec2 sample(const scene::Vec2& u) const { return {sample_1d(u.x()), sample_1d(u.y())}; }
  float width() const { return width_; }

 private:
  static constexpr int kBins = 1000;
  static constexpr int kGuides = 4096;  ///< a power of two: u falls between two of them exactly
  float sample_1d(float u) const;

  float width_;
  std::array<float, kBins + 1>
      cumulative_{};  ///< distribution function at the edges of equal bins of the width
  std::array<std::uint16_t, kGuides> guide_{};  ///< the first edge above i / kGuides: where to search
};

}  // namespace gatelight::renderer
