#pragma once
// The training steps in progress on a device.

#include <deque>
#include <span>
#include <vector>

#include "neural/model/backend.h"
#include "neural/vulkan/feature_store.h"
#include "neural/vulkan/machine.h"
#include "neural/vulkan/network_store.h"
#include "neural/vulkan/step_scratch.h"
#include "neural/vulkan/submission.h"

namespace gatelight::neural::vulkan {

/// Submits steps in groups, and waits for a group's statistics only when they are wanted or room is needed.
class StepQueue {
 public:
  /// The first four must outlive the queue, as must the buffer at `model_block`.
  StepQueue(Machine& machine, const Model& model, const TrainingOptions& options,
            const FeatureStore& features, const NetworkStore& network);

  /// Steps over these batches, in their order. The batches were checked. `model_block` is the ModelBlock's
  /// address.
  void start(std::span<const TrainingBatch> batches, Address model_block);
  /// Whether finish() has statistics to return.
  bool any() const { return !finished_.empty() || started_ > collected_; }
  /// The statistics of the oldest unfinished step.
  StepStatistics finish();
  /// The next step is the first of its state, which sets the output bias.
  void set_first(bool first) { may_be_first_ = first; }

 private:
  struct Group : Submission {
    explicit Group(const Device& device);
    std::size_t steps = 0;
  };

  void submit(std::span<const TrainingBatch> batches, std::uint64_t bytes, Address model_block);
  BatchBlock block_of(const StepCut& cut, const Group& group, std::size_t step) const;
  void collect_oldest();

  Machine& machine_;
  const Model& model_;
  const TrainingOptions& options_;
  const FeatureStore& features_;
  const NetworkStore& network_;
  std::uint32_t tile_;
  StepScratch scratch_;
  std::vector<Group> groups_;
  std::uint64_t started_ = 0, collected_ = 0;  ///< groups
  std::deque<StepStatistics> finished_;
  bool may_be_first_ = true;
};

}  // namespace gatelight::neural::vulkan
