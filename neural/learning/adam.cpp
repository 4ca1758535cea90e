#include "neural/learning/adam.h"

#include <algorithm>
#include <cmath>

namespace gatelight::neural {

double bias_correction(double beta, std::uint64_t t) {
  return -std::expm1(static_cast<double>(t) * std::log(beta));
}

double learning_rate_at(const AdamOptions& options, std::uint64_t t) {
  const double rate = options.learning_rate;
  if (!(options.decay_steps > 0.0f)) return rate;
  return rate / std::sqrt(1.0 + static_cast<double>(t - 1) / options.decay_steps);
}

AdamFactors adam_factors(const AdamOptions& options, std::uint64_t t) {
  const double second = std::sqrt(bias_correction(options.beta2, t));
  return {learning_rate_at(options, t) * second / bias_correction(options.beta1, t),
          options.epsilon * second};
}

double average_rate(const AverageOptions& options, std::uint64_t t) {
  const double ramp = options.ramp > 0.0f ? 1.0 / (1.0 + static_cast<double>(t - 1) / options.ramp) : 0.0;
  return std::max(1.0 - options.decay, ramp);
}

}  // namespace gatelight::neural
