#pragma once
// The picture in square tiles: the unit of work of a thread, and of a batch of camera paths.

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/image/pixel_rect.h"

namespace gatelight::renderer {

/// Pixels of a tile's side. The camera rays of a tile, one a pixel, are traced as one batch: at depth four
/// there are still enough of them to fill packets of 16, and their paths (200 bytes each) stay in the
/// second-level cache.
inline constexpr int kTile = 16;

struct Pixel {
  int x = 0;
  int y = 0;
};

/// Tiles lie on the grid of the full picture, so that a region sees the same batches as the whole.
class TileGrid {
 public:
  explicit TileGrid(const PixelRect& region);

  int count() const { return columns_ * rows_; }
  /// The tile's pixels within the region, in Morton order, which keeps packets of 16 rays square.
  void pixels(int tile, std::vector<Pixel>& result) const;

 private:
  PixelRect region_;
  int first_column_;
  int first_row_;
  int columns_;
  int rows_;
};

}  // namespace gatelight::renderer
