#include "renderer/metrics/flip/summary.h"

#include <tbb/parallel_sort.h>

namespace gatelight::renderer::flip {
namespace {

/// The error at which the running sum of the sorted errors exceeds `part` of their total `sum`.
double weighted_quantile(const std::vector<float>& sorted, double part, double sum) {
  double running = 0.0;
  for (const float error : sorted) {
    running += static_cast<double>(error);
    if (running > part * sum) return static_cast<double>(error);
  }
  return 0.0;
}

}  // namespace

FlipSummary summarize(std::span<const float> errors) {
  std::vector<float> sorted(errors.begin(), errors.end());
  tbb::parallel_sort(sorted.begin(), sorted.end());
  double sum = 0.0;
  for (const float error : sorted) sum += static_cast<double>(error);
  return {.mean = sum / static_cast<double>(sorted.size()),
          .weighted_median = weighted_quantile(sorted, 0.5, sum),
          .first_quartile = weighted_quantile(sorted, 0.25, sum),
          .third_quartile = weighted_quantile(sorted, 0.75, sum),
          .min = static_cast<double>(sorted.front()),
          .max = static_cast<double>(sorted.back())};
}

}  // namespace gatelight::renderer::flip
