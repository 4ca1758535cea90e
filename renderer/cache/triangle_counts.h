#pragma once
// How many steps have trained each triangle with storage.

#include <cstdint>
#include <vector>

#include "renderer/cache/record_batch.h"

namespace gatelight::renderer {

class TriangleCounts {
 public:
  /// Counts nothing.
  TriangleCounts() = default;
  /// starts: whose triangles count where a path began, too; null for those of records alone. Both outlive it.
  TriangleCounts(const neural::GateLayout& layout, const TrainingPoints* starts);

  /// A batch that is learned after `step` steps. Each triangle once, however many records lie on it.
  void add(const RecordBatch& group, std::uint64_t batch, std::uint64_t step);
  /// In the layout's order of triangles; empty where nothing is counted.
  const std::vector<std::uint32_t>& values() const { return counts_; }
  /// From these on, where they are of the same layout.
  void restart(const std::vector<std::uint32_t>& counts);

 private:
  const neural::GateLayout* layout_ = nullptr;
  const TrainingPoints* starts_ = nullptr;
  std::vector<std::uint32_t> counts_;
  std::vector<std::uint64_t> counted_at_;  ///< step after which a triangle was counted last
};

}  // namespace gatelight::renderer
