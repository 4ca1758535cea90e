#pragma once
// A table of Adam's factors by step count, for the kernels.

#include <cstdint>
#include <vector>

#include "neural/cpu/kernels.h"
#include "neural/model/training_options.h"

namespace gatelight::neural::cpu {

KernelAdamStep adam_step(const TrainingOptions& options, std::uint64_t t);

/// The table has entries for t = 0 (unused) to kAdamTableSteps; kernels call adam_step for larger t.
inline constexpr std::uint32_t kAdamTableSteps = 65536;
std::vector<KernelAdamStep> adam_table(const TrainingOptions& options);

}  // namespace gatelight::neural::cpu
