#pragma once
// Exchanges the records of a group of steps, of which each rank traces a share.

#include <vector>

#include "renderer/cache/record_batch.h"
#include "renderer/film/rank_tiles.h"

namespace gatelight::renderer {

/// Assigns each block of the starts to a rank: to the owner of its first pixel, or by the shares of the ranks
/// where the points are no samples of the picture.
void choose_tracers(RecordBatch& batch, const RankTiles& ranks);

/// Packs the results of this rank for all ranks: its records, its samples of pixels of others, and its work.
Bytes pack_records(const RecordBatch& batch, const RankTiles& ranks, const RankWork& work);

/// Completes `batch` by the results of all ranks. Returns the work of each.
std::vector<RankWork> unpack_records(const std::vector<Bytes>& all, const RankTiles& ranks,
                                     RecordBatch& batch);

}  // namespace gatelight::renderer
