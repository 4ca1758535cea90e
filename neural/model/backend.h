#pragma once
// The seam between what is learned and the machine that learns it. Members of equal rank: CPU, Vulkan, and
// the reference in double precision.

#include <cstdint>
#include <deque>
#include <span>
#include <string>

#include "neural/base/batch.h"
#include "neural/model/state.h"

namespace gatelight::neural {

struct StepStatistics {
  double loss = 0.0;           ///< mean over accepted records and outputs, before the step; 0 for none
  std::uint64_t records = 0;   ///< accepted
  std::uint64_t rejected = 0;  ///< NaN or infinity in an input that the model reads, or in the target
  std::uint64_t unstored = 0;  ///< finite, but on a surface without storage or out of the layout's range
  std::uint64_t clipped = 0;   ///< accepted with a target clamped to max_target
  /// Nodes that an accepted record reads with a weight other than 0. A node whose weights are all 0 (at a
  /// corner, along an edge) is not touched: no step, no decay of its moments with sparse updates.
  std::uint64_t touched_nodes = 0;
  std::uint64_t skipped_updates =
      0;  ///< parameters (weights) or nodes left alone for a gradient that is not finite
  double seconds_network = 0.0;  ///< encode, forward, loss, backward
  double seconds_sort = 0.0;     ///< gradients to their nodes
  double seconds_update = 0.0;   ///< reduction and Adam
  double seconds = 0.0;          ///< the whole call
};

enum class QueryPrecision : std::uint8_t { fp32, bf16 };

/// What a query does to the network's linear output. A value that is not finite becomes 0 unless raw.
enum class OutputRange : std::uint8_t { raw, non_negative, unit };

struct QueryOptions {
  QueryPrecision precision = QueryPrecision::fp32;  ///< bf16: weights and activations rounded, sums in fp32
  OutputRange range = OutputRange::non_negative;
  bool averaged = true;  ///< the averages, else the raw parameters
};

/// One thread calls at a time. A batch with spans of the wrong length throws BadConfiguration and changes
/// nothing. The same bits for any number of threads.
class Backend {
 public:
  virtual ~Backend() = default;
  /// One step over the whole batch, while none is started and unfinished. A batch without an accepted record
  /// changes nothing.
  virtual StepStatistics train(const TrainingBatch& batch) = 0;
  /// Starts such a step; the batch may be changed at once. What is asked, exported or started afterwards
  /// comes after it.
  virtual void start(const TrainingBatch& batch);
  /// Of the oldest step that was started and not finished yet; waits for it. Throws BadConfiguration where
  /// there is none.
  virtual StepStatistics finish();
  /// Whether start returns while the step is still being made.
  virtual bool runs_alongside() const { return false; }
  /// out: batch.size x outputs, row-major. Points without storage encode to zero features. A point with an
  /// input that is not finite (and that the model reads) answers NaN, and so 0 unless raw.
  virtual void query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const = 0;
  virtual ModelState export_state() const = 0;
  /// Throws BadConfiguration when the sizes are not the model's.
  virtual void import_state(const ModelState& state) = 0;
  /// "cpu avx512", "reference", "vulkan NAME": for records.
  virtual std::string name() const = 0;
  virtual std::uint64_t parameter_bytes() const = 0;
  virtual std::uint64_t optimizer_bytes() const = 0;  ///< moments, masters, averages, counters

 private:
  std::deque<StepStatistics> made_;
};

}  // namespace gatelight::neural
