#include "neural/learning/training_counts.h"

#include <algorithm>
#include <cassert>

namespace gatelight::neural {

namespace {

constexpr std::uint32_t kGreatestCount = 512;

float candidate_weight(std::uint32_t candidate, std::span<const std::uint32_t> counts) {
  return candidate < counts.size() ? training_weight(counts[candidate]) : 1.0f;
}

}  // namespace

float training_weight(std::uint32_t count) {
  return 1.0f / static_cast<float>(std::clamp(count, 1u, kGreatestCount));
}

// Sums of equal weights are exact in double, so equal counts give the uniform choice floor(u * size).
std::size_t choose_candidate(std::span<const std::uint32_t> candidates, std::span<const std::uint32_t> counts,
                             float u) {
  assert(!candidates.empty());
  double total = 0.0;
  for (const std::uint32_t candidate : candidates) total += candidate_weight(candidate, counts);
  const double chosen = static_cast<double>(u) * total;
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < candidates.size(); ++i) {
    sum += candidate_weight(candidates[i], counts);
    if (chosen < sum) return i;
  }
  return candidates.size() - 1;
}

}  // namespace gatelight::neural
