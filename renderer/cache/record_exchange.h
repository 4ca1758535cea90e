#pragma once
// The exchange of records between the processes that train one cache, each of which traces a share of them.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "renderer/distributed/ranks.h"
#include "renderer/distributed/shares.h"
#include "renderer/film/tiles.h"

namespace gatelight::renderer {

struct RecordBatch;

/// The tiles of a picture, and the processes that have them. Shares may change.
struct SharedTiles {
  SharedTiles(Ranks& all, const TileGrid& grid, std::span<const double> speeds)
      : ranks(all), tiles(grid), shares(grid.count(), speeds) {}

  Ranks& ranks;
  TileGrid tiles;
  Shares shares;

  int owner(const Pixel& pixel) const { return shares.owner(tiles.tile_at(pixel)); }
  bool owns(const Pixel& pixel) const { return owner(pixel) == ranks.rank(); }
  TileGrid own() const { return tiles.part(shares.begin(ranks.rank()), shares.end(ranks.rank())); }
};

/// All processes call the same functions in the same order. A single process traces all records, and the
/// functions change nothing.
class RecordExchange {
 public:
  /// Of a single process.
  RecordExchange() = default;
  /// The tiles must outlive it.
  explicit RecordExchange(const SharedTiles& tiles) : all_(tiles.ranks.is_single() ? nullptr : &tiles) {}

  bool is_alone() const { return all_ == nullptr; }
  /// Whether rays that all processes trace alike are counted here: one of them does.
  bool counts_common_rays() const { return is_alone() || all_->ranks.first(); }
  /// Whether the samples of a pixel are added here.
  bool owns(const Pixel& pixel) const { return is_alone() || all_->owns(pixel); }

  /// Assigns each block of the starts to a process: to the owner of its first pixel, or by the shares where
  /// the points are no samples of the picture. Call it between begin() and trace() of a source.
  void choose_blocks(RecordBatch& batch) const;

  /// Records on their way.
  using Coming = std::unique_ptr<Ranks::Exchange>;
  /// Gives all the records that were traced here, and the samples of pixels of others. `work`: that of
  /// this process for the batch. The caller may go on until it calls receive().
  Coming send(const RecordBatch& batch, const RankWork& work);
  /// Completes a batch by the results of all.
  void receive(Coming coming, RecordBatch& batch);

  using Rebalance = std::function<void(const std::vector<RankWork>& work)>;
  /// Gives `use` the work of each process since the last call, about once a second.
  void rebalance(const Rebalance& use);

  /// The answer of the first process.
  bool agreed(bool mine) const { return is_alone() ? mine : all_->ranks.agreed(mine); }
  /// The exact sum of integers of all.
  double sum(double mine) const { return is_alone() ? mine : all_->ranks.sum(mine); }

  /// What this process has done; nothing for a single process.
  struct Share {
    std::uint64_t paths = 0;  ///< traced
    std::uint64_t bytes = 0;  ///< of records, sent to others
  };
  Share share;

 private:
  const SharedTiles* all_ = nullptr;  ///< null: a single process
  std::vector<RankWork> work_;        ///< of each process, since the last rebalance
};

}  // namespace gatelight::renderer
