#include "neural/cpu/adam_table.h"

#include "neural/learning/adam.h"

namespace gatelight::neural::cpu {

KernelAdamStep adam_step(const TrainingOptions& options, std::uint64_t t) {
  const AdamFactors factors = adam_factors(options.adam, t);
  return {static_cast<float>(factors.step), static_cast<float>(factors.epsilon),
          static_cast<float>(average_rate(options.average, t)), 0.0f};
}

std::vector<KernelAdamStep> adam_table(const TrainingOptions& options) {
  std::vector<KernelAdamStep> table(kAdamTableSteps + 1);
  for (std::uint32_t t = 1; t <= kAdamTableSteps; ++t) table[t] = adam_step(options, t);
  return table;
}

}  // namespace gatelight::neural::cpu
