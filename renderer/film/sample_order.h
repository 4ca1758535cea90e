#pragma once
// The order in which single samples of a picture are taken while a cache is trained on them.

#include <cstdint>

#include "renderer/film/tiles.h"
#include "renderer/image/pixel_rect.h"

namespace gatelight::renderer {

/// Visits every pixel once, then every pixel again. Any part of it covers the picture evenly: places step
/// along Roberts' R2 lattice of low discrepancy, wrapped around the rows.
class SampleOrder {
 public:
  explicit SampleOrder(const PixelRect& region);

  PixelSample at(std::uint64_t index) const;

 private:
  PixelRect region_;
  std::uint64_t pixels_;
  std::uint64_t step_;  ///< in pixels; has no divisor with their number
};

}  // namespace gatelight::renderer
