#include "renderer/film/tiles.h"

namespace gatelight::renderer {
namespace {

struct TileOrder {
  std::array<std::uint8_t, kTile * kTile> x{};
  std::array<std::uint8_t, kTile * kTile> y{};
};
constexpr TileOrder kTileOrder = [] {
  TileOrder order;
  for (std::size_t i = 0; i < kTile * kTile; ++i) {
    std::size_t x = 0;
    std::size_t y = 0;
    for (std::size_t bit = 0; bit < 4; ++bit) {
      x |= (i >> (2 * bit) & 1u) << bit;
      y |= (i >> (2 * bit + 1) & 1u) << bit;
    }
    order.x[i] = static_cast<std::uint8_t>(x);
    order.y[i] = static_cast<std::uint8_t>(y);
  }
  return order;
}();

}  // namespace

TileGrid::TileGrid(const PixelRect& region)
    : region_(region),
      first_column_(region.x0 / kTile),
      first_row_(region.y0 / kTile),
      columns_((region.x1 + kTile - 1) / kTile - first_column_),
      rows_((region.y1 + kTile - 1) / kTile - first_row_) {}

void TileGrid::pixels(int tile, std::vector<Pixel>& result) const {
  result.clear();
  const int left = (first_column_ + tile % columns_) * kTile;
  const int top = (first_row_ + tile / columns_) * kTile;
  for (std::size_t i = 0; i < kTile * kTile; ++i) {
    const Pixel p{left + kTileOrder.x[i], top + kTileOrder.y[i]};
    if (p.x < region_.x0 || p.x >= region_.x1 || p.y < region_.y0 || p.y >= region_.y1) continue;
    result.push_back(p);
  }
}

}  // namespace gatelight::renderer
