#pragma once
// The exchange of records between the ranks that train one cache, each of which traces a share of them.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "renderer/distributed/ranks.h"
#include "renderer/distributed/shares.h"
#include "renderer/film/tiles.h"

namespace gatelight::renderer {

struct RecordBatch;

/// The ranks that make one picture, and their tiles. The references outlive it. Shares may change.
struct RankTiles {
  Ranks& ranks;
  const TileGrid& tiles;
  const Shares& shares;

  int owner(const Pixel& pixel) const { return shares.owner(tiles.tile_at(pixel)); }
  bool owns(const Pixel& pixel) const { return owner(pixel) == ranks.rank(); }
};

/// All ranks call the same functions in the same order. A single process traces all records, and the
/// functions change nothing.
class RecordExchange {
 public:
  /// Of a single process.
  RecordExchange() = default;
  /// The ranks must outlive it.
  explicit RecordExchange(const RankTiles& ranks) : ranks_(ranks.ranks.is_single() ? nullptr : &ranks) {}

  bool is_alone() const { return ranks_ == nullptr; }
  /// Whether rays that all ranks trace alike are counted here: one of them does.
  bool counts_common_rays() const { return is_alone() || ranks_->ranks.first(); }
  /// Whether the samples of a pixel are added here.
  bool owns(const Pixel& pixel) const { return is_alone() || ranks_->owns(pixel); }

  /// Assigns each block of the starts to a rank: to the owner of its first pixel, or by the shares of the
  /// ranks where the points are no samples of the picture. Call it between begin() and trace() of a source.
  void choose_blocks(RecordBatch& batch) const;

  /// Records on their way.
  using Coming = std::unique_ptr<Ranks::AllGather>;
  /// Gives all ranks the records that were traced here, and the samples of pixels of others. `work`: that of
  /// this rank for the batch. The caller may go on until it calls receive().
  Coming send(const RecordBatch& batch, const RankWork& work);
  /// Completes a batch by the results of all ranks.
  void receive(Coming coming, RecordBatch& batch);

  using Rebalance = std::function<void(const std::vector<RankWork>& work)>;
  /// Gives `use` the work of each rank since the last call, about once a second.
  void rebalance(const Rebalance& use);

  /// Rank 0's answer.
  bool agreed(bool mine) const { return is_alone() ? mine : ranks_->ranks.agreed(mine); }
  /// The exact sum of integers of all ranks.
  double sum(double mine) const { return is_alone() ? mine : ranks_->ranks.sum(mine); }

  /// What this rank has done; nothing for a single process.
  struct Share {
    std::uint64_t paths = 0;  ///< traced
    std::uint64_t bytes = 0;  ///< of records, sent to others
  };
  Share share;

 private:
  const RankTiles* ranks_ = nullptr;  ///< null: a single process
  std::vector<RankWork> work_;        ///< of the ranks, since the last rebalance
};

}  // namespace gatelight::renderer
