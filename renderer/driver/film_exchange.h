#pragma once
// Exchanges the pixels of a film whose tiles are distributed over several ranks.

#include <functional>

#include "renderer/distributed/ranks.h"
#include "renderer/distributed/shares.h"
#include "renderer/film/film.h"
#include "renderer/film/tiles.h"

namespace gatelight::renderer {

/// Sends each rank the sums of the tiles that it wants and another rank has. `tiles` are those of the whole
/// film, which `shares` distributes. `wants` is the same on all ranks.
void exchange_tiles(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks,
                    const std::function<bool(int rank, int tile)>& wants);

/// Rank 0 gets the whole film.
void gather_film(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks);

}  // namespace gatelight::renderer
