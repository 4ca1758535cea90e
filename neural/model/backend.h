#pragma once
// The interface of the backends that train and query a model: CPU, Vulkan, and the reference in double
// precision.

#include <cstdint>
#include <deque>
#include <span>
#include <string>

#include "neural/model/batch.h"
#include "neural/model/state.h"

namespace gatelight {
class Team;  // base/parallel/team.h
}

namespace gatelight::neural {

struct StepStatistics {
  double loss = 0.0;  ///< mean over accepted records and outputs, before the step; 0 if none is accepted
  std::uint64_t records = 0;   ///< accepted
  std::uint64_t rejected = 0;  ///< NaN or infinity in the target or in an input that the model reads
  std::uint64_t unstored = 0;  ///< finite, but on a surface without storage or out of the layout's range
  std::uint64_t clipped = 0;   ///< accepted, with a target clamped to max_target
  /// Nodes that an accepted record reads with a weight other than 0. With sparse updates a node whose weights
  /// are all 0 (at a corner, along an edge) takes no step, and its moments do not decay.
  std::uint64_t touched_nodes = 0;
  std::uint64_t skipped_updates = 0;  ///< parameters of the network or nodes whose gradient is not finite
  double seconds_network = 0.0;       ///< encode, forward, loss, backward
  double seconds_sort = 0.0;          ///< sorting gradients by node, if it is a separate step
  double seconds_update = 0.0;        ///< reduction and Adam
  double seconds = 0.0;               ///< the whole call
};

enum class QueryPrecision : std::uint8_t { fp32, bf16 };

/// The range that a query clamps the network's linear output to. Values that are not finite become 0, except
/// with `raw`.
enum class OutputRange : std::uint8_t { raw, non_negative, unit };

struct QueryOptions {
  QueryPrecision precision = QueryPrecision::fp32;  ///< bf16 rounds weights and activations and sums in fp32
  OutputRange range = OutputRange::non_negative;
  bool averaged = true;  ///< use the averages; else the raw parameters
};

/// Trains and queries one model. Only one thread at a time may call its functions; query() is an exception if
/// answers_threads(). Results have the same bits for any number of threads. A batch with spans of the wrong
/// length throws BadConfiguration and changes nothing.
class Backend {
 public:
  virtual ~Backend() = default;
  /// Makes one step over the whole batch. All started steps must be finished before. A batch without an
  /// accepted record changes nothing.
  virtual StepStatistics train(const TrainingBatch& batch) = 0;
  /// The same, called by the leader of a team whose threads share the work.
  virtual StepStatistics train(const TrainingBatch& batch, Team&) { return train(batch); }
  /// Starts a step over each batch, in their order. The caller may change the batches as soon as this
  /// returns. Later queries, exports and steps see the result. A device gets as many steps at once as it has
  /// room for.
  virtual void start(std::span<const TrainingBatch> batches, Team* team = nullptr);
  void start(const TrainingBatch& batch, Team* team = nullptr) { start({&batch, 1}, team); }
  /// Waits for the oldest unfinished step and returns its statistics. Throws BadConfiguration if there is
  /// none.
  virtual StepStatistics finish();
  /// Whether start returns before the steps are complete.
  virtual bool runs_alongside() const { return false; }
  /// Whether several threads may query at a time, while no other function runs.
  virtual bool answers_threads() const { return false; }
  /// Writes batch.size x outputs floats, row-major. Points without storage have zero features. A point with a
  /// non-finite input that the model reads gives NaN with `raw`, else 0.
  virtual void query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const = 0;
  virtual ModelState export_state() const = 0;
  /// Throws BadConfiguration if the sizes do not match the model.
  virtual void import_state(const ModelState& state) = 0;
  /// "cpu avx512", "reference" or "vulkan NAME", for reports.
  virtual std::string name() const = 0;
  virtual std::uint64_t parameter_bytes() const = 0;
  virtual std::uint64_t optimizer_bytes() const = 0;  ///< moments, masters, averages, counters

 private:
  std::deque<StepStatistics> made_;
};

}  // namespace gatelight::neural
