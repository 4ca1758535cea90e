#include "renderer/driver/time_budget.h"

#include <algorithm>

namespace gatelight::renderer {
namespace {

/// Training's share of the time that it and the passes have together (README.md).
constexpr double kTrainingShare = 0.2;
constexpr double kShareOfTrainingSamples = 0.4;

}  // namespace

double TimeBudget::training_end(double now, bool training_paths_are_samples) const {
  const double left = passes_end() - now;
  return now + (training_paths_are_samples ? kShareOfTrainingSamples : kTrainingShare) * std::max(left, 0.0);
}

int samples_of_pass(double now, double seconds_per_sample, double usual, double end, int most) {
  const double budget = std::min(usual, end - now), fitting = budget / std::max(seconds_per_sample, 1e-9);
  return static_cast<int>(std::clamp(fitting, 1.0, static_cast<double>(std::max(most, 1))));
}

}  // namespace gatelight::renderer
