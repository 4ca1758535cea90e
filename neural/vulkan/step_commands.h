#pragma once
// The dispatches of a training step, in their order.

#include "neural/model/training_options.h"
#include "neural/vulkan/commands.h"
#include "neural/vulkan/feature_store.h"
#include "neural/vulkan/step_scratch.h"
#include "neural/vulkan/submission.h"

namespace gatelight::neural::vulkan {

struct StepPlan {
  const Model& model;
  const TrainingOptions& options;
  const FeatureStore& features;
  StepCut cut;
  std::uint32_t tile = 1;
  bool may_be_first = false;  ///< no step is known to have been made: the output bias may have to be set
};

/// From the copy of the batch to that of the statistics.
void record_step(const StepPlan& plan, const Submission& step, std::uint64_t upload_bytes,
                 Commands& commands);

/// The packed weights that training reads, from the parameters.
void record_training_pack(const Model& model, Commands& commands);

}  // namespace gatelight::neural::vulkan
