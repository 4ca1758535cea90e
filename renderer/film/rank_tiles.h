#pragma once
// The rank that owns a pixel, where several ranks make one picture.

#include "renderer/distributed/ranks.h"
#include "renderer/distributed/shares.h"
#include "renderer/film/tiles.h"

namespace gatelight::renderer {

/// The references outlive it. Shares may change.
struct RankTiles {
  Ranks& ranks;
  const TileGrid& tiles;
  const Shares& shares;

  int owner(const Pixel& pixel) const { return shares.owner(tiles.tile_at(pixel)); }
  bool owns(const Pixel& pixel) const { return owner(pixel) == ranks.rank(); }
};

}  // namespace gatelight::renderer
