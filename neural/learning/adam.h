#pragma once
// The factors of Adam and of the average for a step count t, in double precision, for t = 1 to beyond 1e9.

#include <cstdint>

#include "neural/model/training_options.h"

namespace gatelight::neural {

/// 1 - beta^t, without cancellation at small t; exactly 1 once beta^t vanishes.
double bias_correction(double beta, std::uint64_t t);

/// lr / sqrt(1 + (t-1)/decay_steps).
double learning_rate_at(const AdamOptions& options, std::uint64_t t);

/// Factors that include the bias corrections: p -= step m / (sqrt(v) + epsilon), with the uncorrected m and
/// v.
struct AdamFactors {
  double step = 0.0;
  double epsilon = 0.0;
};
AdamFactors adam_factors(const AdamOptions& options, std::uint64_t t);

/// 1 - d(t), the fraction by which an average moves to the new value.
double average_rate(const AverageOptions& options, std::uint64_t t);

}  // namespace gatelight::neural
