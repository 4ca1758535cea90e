#include "neural/cpu/adam_table.h"

#include <algorithm>

#include "base/parallel/loops.h"
#include "neural/learning/adam.h"

namespace gatelight::neural::cpu {

KernelAdamStep adam_step(const TrainingOptions& options, std::uint64_t t) {
  const AdamFactors factors = adam_factors(options.adam, t);
  return {static_cast<float>(factors.step), static_cast<float>(factors.epsilon),
          static_cast<float>(average_rate(options.average, t)), 0.0f};
}

std::vector<KernelAdamStep> adam_table(const TrainingOptions& options) {
  std::vector<KernelAdamStep> table(kAdamTableSteps + 1);
  for_each_range(table.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = std::max<std::size_t>(begin, 1); t < end; ++t) table[t] = adam_step(options, t);
  });
  return table;
}

}  // namespace gatelight::neural::cpu
