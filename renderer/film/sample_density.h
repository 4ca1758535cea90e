#pragma once
// How many samples each pixel takes in a pass that gives some pixels more than others.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/film/tiles.h"
#include "renderer/image/pixel_rect.h"

namespace gatelight::renderer {

/// Shares of the samples of passes, for each half of a film apart.
class SampleDensity {
 public:
  static constexpr float kMost = 64.0f;

  /// One value of each half for each pixel of `rect`, at least 0, in rows from the top. They are scaled so
  /// that a pass takes one sample for each pixel on average, half of them for each half, and at most kMost
  /// for one.
  SampleDensity(const PixelRect& rect, std::array<std::vector<float>, 2> values);

  /// With values as they are.
  static SampleDensity restore(const PixelRect& rect, std::array<std::vector<float>, 2> values);

  /// Samples of a half of a pixel in pass number `pass`, from 0. Sums over passes are the density's, rounded:
  /// where in a pass they fall differs from pixel to pixel.
  std::uint32_t count(const Pixel& p, std::size_t half, std::uint64_t pass) const;

  const std::array<std::vector<float>, 2>& values() const { return values_; }

 private:
  SampleDensity() = default;

  PixelRect rect_;
  std::array<std::vector<float>, 2> values_;
};

}  // namespace gatelight::renderer
