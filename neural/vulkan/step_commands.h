#pragma once
// Records the dispatches of a training step.

#include "neural/model/training_options.h"
#include "neural/vulkan/commands.h"
#include "neural/vulkan/feature_store.h"
#include "neural/vulkan/step_scratch.h"

namespace gatelight::neural::vulkan {

struct StepPlan {
  const Model& model;
  const TrainingOptions& options;
  const FeatureStore& features;
  StepCut cut;
  std::uint32_t tile = 1;
  bool may_be_first = false;  ///< this may be the first step, which sets the output bias
};

/// Stamps that a step writes: after the network, after the sort, at its end.
inline constexpr std::uint32_t kStepStamps = 3;

/// Records a step over a batch that is on the device. Stamp number `start` is the one before it.
void record_step(const StepPlan& plan, const vk::raii::QueryPool& stamps, std::uint32_t start,
                 Commands& commands);

/// Records the packing of imported parameters into the weights that training reads.
void record_training_pack(const Model& model, Commands& commands);

}  // namespace gatelight::neural::vulkan
