#pragma once
// Records the dispatches of a training step.

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
  bool may_be_first = false;  ///< this may be the first step, which sets the output bias
};

/// Records a step, from the copy of the batch to the copy of the statistics.
void record_step(const StepPlan& plan, const Submission& step, std::uint64_t upload_bytes,
                 Commands& commands);

/// Records the packing of the parameters into the weights that training reads.
void record_training_pack(const Model& model, Commands& commands);

}  // namespace gatelight::neural::vulkan
