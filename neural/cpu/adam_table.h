#pragma once
// Adam's factors for each step count, so that kernels look them up.

#include <cstdint>
#include <vector>

#include "neural/cpu/kernels.h"
#include "neural/model/training_options.h"

namespace gatelight::neural::cpu {

KernelAdamStep adam_step(const TrainingOptions& options, std::uint64_t t);

/// Entries for t = 0 (unused) to kAdamTableSteps; kernels ask adam_step for greater ones.
inline constexpr std::uint32_t kAdamTableSteps = 65536;
std::vector<KernelAdamStep> adam_table(const TrainingOptions& options);

}  // namespace gatelight::neural::cpu
