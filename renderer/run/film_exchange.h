#pragma once
// The pixels of a film whose tiles several ranks have.

#include <functional>

#include "renderer/film/film.h"
#include "renderer/film/tiles.h"
#include "renderer/ranks/ranks.h"
#include "renderer/ranks/shares.h"

namespace gatelight::renderer {

/// Gives each rank the sums of the tiles that it wants and another one has. `tiles`: of the whole film, which
/// `shares` deals. `wants` is the same on all ranks.
void exchange_tiles(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks,
                    const std::function<bool(int rank, int tile)>& wants);

/// Rank 0 gets the whole film.
void gather_film(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks);

}  // namespace gatelight::renderer
