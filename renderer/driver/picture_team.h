#pragma once
// The tiles of a film, distributed over the ranks that make it.

#include <cstdint>
#include <functional>
#include <vector>

#include "renderer/distributed/ranks.h"
#include "renderer/distributed/shares.h"
#include "renderer/film/film.h"
#include "renderer/film/rank_tiles.h"
#include "renderer/film/tiles.h"

namespace gatelight::renderer {

/// All ranks call the same functions. A single process has all tiles.
class DistributedTiles {
 public:
  /// `threads`: of this rank. The ranks must outlive the tiles.
  DistributedTiles(const PixelRect& region, Ranks& ranks, int threads);
  DistributedTiles(const DistributedTiles&) = delete;
  DistributedTiles& operator=(const DistributedTiles&) = delete;

  Ranks& ranks() const { return ranks_; }
  /// This rank's tiles; rebalance() changes them.
  const TileGrid& own() const { return own_; }
  const RankTiles& owners() const { return owners_; }
  /// This rank's rows of a picture, as many as its threads can do.
  PixelRect own_rows(const PixelRect& picture) const;

  /// Rank 0 gets the whole film.
  void gather(Film& film) const;
  /// Distributes the tiles anew where some rank took much longer than others.
  void rebalance(Film& film, const std::vector<RankWork>& measured);

  /// Number of samples in this rank's tiles.
  std::uint64_t own_samples(const Film& film) const;
  /// Mean over all pixels, of all ranks.
  double samples_per_pixel(const Film& film) const;

 private:
  /// Sends each rank the sums of the tiles that it wants and another rank has by `shares`. `wants` is the
  /// same on all ranks.
  void exchange(Film& film, const Shares& shares, const std::function<bool(int rank, int tile)>& wants) const;

  Ranks& ranks_;
  std::vector<double> threads_;  ///< of the ranks
  TileGrid tiles_;               ///< of the whole film
  Shares shares_;
  TileGrid own_;
  RankTiles owners_{ranks_, tiles_, shares_};
};

}  // namespace gatelight::renderer
