#pragma once
// The records of a group of steps, of which each rank traces its share.

#include <vector>

#include "renderer/cache/record_batch.h"
#include "renderer/film/rank_tiles.h"

namespace gatelight::renderer {

/// Says which rank traces which block of the starts: the owner of its first pixel, or for points that are no
/// samples of the picture, ranks in turn by their shares.
void choose_tracers(RecordBatch& batch, const RankTiles& ranks);

/// What this rank has traced, for all ranks: its records, the samples that belong to pixels of others, and
/// how much work it was.
Bytes pack_records(const RecordBatch& batch, const RankTiles& ranks, const RankWork& work);

/// Completes `batch` by what all ranks sent. Returns the work of each.
std::vector<RankWork> unpack_records(const std::vector<Bytes>& all, const RankTiles& ranks,
                                     RecordBatch& batch);

}  // namespace gatelight::renderer
