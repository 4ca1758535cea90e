#include "renderer/film/tiles.h"

#include <algorithm>

namespace gatelight::renderer {
namespace {

/// The bits of a coordinate, at every second place.
constexpr std::uint32_t spread(int coordinate) {
  auto bits = static_cast<std::uint32_t>(coordinate) & 0xffffu;
  bits = (bits | bits << 8) & 0x00ff00ffu;
  bits = (bits | bits << 4) & 0x0f0f0f0fu;
  bits = (bits | bits << 2) & 0x33333333u;
  return (bits | bits << 1) & 0x55555555u;
}

constexpr std::uint32_t morton_of(const Pixel& pixel) {
  return spread(pixel.x) | spread(pixel.y) << 1;
}

/// The places of a tile's pixels in Morton order.
constexpr std::array<Pixel, kTile* kTile> kTileOrder = [] {
  std::array<Pixel, kTile * kTile> order{};
  for (int y = 0; y < kTile; ++y) {
    for (int x = 0; x < kTile; ++x) order[morton_of({x, y})] = {x, y};
  }
  return order;
}();

}  // namespace

std::uint32_t morton(const Pixel& pixel) {
  return morton_of(pixel);
}

TileGrid::TileGrid(const PixelRect& region)
    : region_(region),
      first_column_(region.x0 / kTile),
      first_row_(region.y0 / kTile),
      columns_((region.x1 + kTile - 1) / kTile - first_column_),
      end_(columns_ * ((region.y1 + kTile - 1) / kTile - first_row_)) {}

TileGrid TileGrid::part(int first, int end) const {
  TileGrid grid = *this;
  grid.begin_ = begin_ + first;
  grid.end_ = begin_ + end;
  return grid;
}

int TileGrid::tile_at(const Pixel& pixel) const {
  return (pixel.y / kTile - first_row_) * columns_ + pixel.x / kTile - first_column_ - begin_;
}

std::pair<int, int> TileGrid::columns(int y) const {
  const int first = (y / kTile - first_row_) * columns_;
  const auto left_of = [&](int tile) {
    const int column = std::clamp(tile - first, 0, columns_);
    return std::clamp((first_column_ + column) * kTile, region_.x0, region_.x1);
  };
  return {left_of(begin_), left_of(end_)};
}

void TileGrid::pixels(int number, std::vector<Pixel>& result) const {
  result.clear();
  const int tile = begin_ + number;
  const int left = (first_column_ + tile % columns_) * kTile;
  const int top = (first_row_ + tile / columns_) * kTile;
  for (const Pixel& place : kTileOrder) {
    const Pixel p{left + place.x, top + place.y};
    if (p.x < region_.x0 || p.x >= region_.x1 || p.y < region_.y0 || p.y >= region_.y1) continue;
    result.push_back(p);
  }
}

}  // namespace gatelight::renderer
