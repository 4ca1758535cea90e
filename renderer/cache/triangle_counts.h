#pragma once
// Counts the training steps of each triangle with storage.

#include <cstdint>
#include <vector>

#include "renderer/cache/record_batch.h"

namespace gatelight::renderer {

class TriangleCounts {
 public:
  /// Counts nothing.
  TriangleCounts() = default;
  /// Counts triangles of records and, unless `starts` is null, those where paths begin. Both must outlive it.
  TriangleCounts(const neural::GateLayout& layout, const TrainingPoints* starts);

  /// Counts a batch that is learned after `step` steps: each triangle once, regardless of its number of
  /// records.
  void add(const RecordBatch& group, std::uint64_t batch, std::uint64_t step);
  /// One number for each triangle of the layout; empty where nothing is counted.
  const std::vector<std::uint32_t>& values() const { return counts_; }
  /// Continues from these numbers if they are of the same layout.
  void restart(const std::vector<std::uint32_t>& counts);

 private:
  const neural::GateLayout* layout_ = nullptr;
  const TrainingPoints* starts_ = nullptr;
  std::vector<std::uint32_t> counts_;
  std::vector<std::uint64_t> counted_at_;  ///< step after which a triangle was counted last
};

}  // namespace gatelight::renderer
