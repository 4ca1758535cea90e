#include "renderer/film/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace gatelight::renderer {
namespace {

/// The pixels of each tile, in their order.
std::vector<std::vector<std::pair<int, int>>> tiles_of(const PixelRect& region) {
  const TileGrid grid(region);
  std::vector<std::vector<std::pair<int, int>>> tiles;
  std::vector<Pixel> pixels;
  for (int tile = 0; tile < grid.count(); ++tile) {
    grid.pixels(tile, pixels);
    tiles.emplace_back();
    for (const Pixel& p : pixels) tiles.back().emplace_back(p.x, p.y);
  }
  return tiles;
}

TEST(Tiles, EachPacketOfSixteenIsASquare) {
  for (const auto& tile : tiles_of({0, 0, 64, 32})) {
    ASSERT_EQ(tile.size(), 256u);
    for (std::size_t i = 0; i < tile.size(); ++i) {
      EXPECT_EQ(tile[i].first / 4, tile[i / 16 * 16].first / 4) << i;
      EXPECT_EQ(tile[i].second / 4, tile[i / 16 * 16].second / 4) << i;
    }
  }
}

TEST(Tiles, ARegionHasTheTilesOfTheWholePicture) {
  const PixelRect region{20, 5, 70, 37};
  auto whole = tiles_of({0, 0, 80, 48});
  for (auto& tile : whole) {
    std::erase_if(tile, [&](const auto& p) {
      return p.first < region.x0 || p.first >= region.x1 || p.second < region.y0 || p.second >= region.y1;
    });
  }
  std::erase_if(whole, [](const auto& tile) { return tile.empty(); });
  EXPECT_EQ(tiles_of(region), whole);
}

TEST(Tiles, PartsShareTheColumnsOfARow) {
  const PixelRect region{20, 5, 70, 37};
  const TileGrid grid(region);
  for (const int middle : {0, 2, 5, grid.count()}) {
    const TileGrid parts[] = {grid.part(0, middle), grid.part(middle, grid.count())};
    for (const TileGrid& part : parts) {
      std::vector<std::pair<int, int>> expected, found;
      std::vector<Pixel> pixels;
      for (int tile = 0; tile < part.count(); ++tile) {
        part.pixels(tile, pixels);
        for (const Pixel& p : pixels) expected.emplace_back(p.y, p.x);
      }
      std::sort(expected.begin(), expected.end());
      for (int y = region.y0; y < region.y1; ++y) {
        const auto [first, end] = part.columns(y);
        for (int x = first; x < end; ++x) found.emplace_back(y, x);
      }
      EXPECT_EQ(found, expected) << middle;
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
