#pragma once
// Splits the picture into square tiles. A tile is the unit of work of a thread, and a batch of camera paths.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "renderer/image/pixel_rect.h"

namespace gatelight::renderer {

/// The side of a tile in pixels. The camera rays of a tile, one per pixel, are traced as one batch. At depth
/// four enough rays remain to fill packets of 16, and their paths (200 bytes each) stay in the second-level
/// cache.
inline constexpr int kTile = 16;

struct Pixel {
  int x = 0;
  int y = 0;
};

/// A sample of a pixel. Random numbers depend on its number. Even ones belong to the first half of the
/// pixel's samples, odd ones to the second.
struct PixelSample {
  Pixel pixel;
  std::uint32_t number = 0;

  bool in_first_half() const { return number % 2 == 0; }
};

/// The number of a pixel in Morton order, in which pixels with near numbers are near each other. Coordinates
/// are below 2^16.
std::uint32_t morton(const Pixel& pixel);

/// Tiles lie on the grid of the full picture, so that a region has the same batches as the full picture.
class TileGrid {
 public:
  explicit TileGrid(const PixelRect& region);

  /// The tiles first <= tile < end of a grid, as a grid of its own.
  TileGrid part(int first, int end) const;

  int count() const { return end_ - begin_; }
  /// The tile that holds a pixel of the region.
  int tile_at(const Pixel& pixel) const;
  /// The pixels first <= x < end of a row of the picture that are in these tiles. They are contiguous.
  std::pair<int, int> columns(int y) const;
  /// Sets `result` to the tile's pixels within the region, in Morton order, which keeps packets of 16 rays
  /// square.
  void pixels(int tile, std::vector<Pixel>& result) const;

 private:
  PixelRect region_;
  int first_column_;
  int first_row_;
  int columns_;
  int begin_ = 0;  ///< number of the first tile among those of the whole region, in rows from the top
  int end_;
};

}  // namespace gatelight::renderer
