#include "neural/learning/training_counts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "tests/support/statistics.h"

namespace gatelight::neural {
namespace {

using gatelight::testing::accepts;
using gatelight::testing::chi_square_test;
using gatelight::testing::Random;
using gatelight::testing::sidak;

constexpr std::size_t kCandidates = 16;
constexpr std::size_t kSamples = 200000;
constexpr double kSignificance = 1e-4;
constexpr std::size_t kTests = 3;

/// The paper's formula, in double.
double expected_weight(std::uint32_t count) {
  return 1.0 / std::min(512.0, std::max(1.0, static_cast<double>(count)));
}

void expect_choices_by_weight(const std::vector<std::uint32_t>& candidates,
                              const std::vector<std::uint32_t>& counts, std::uint64_t seed) {
  const std::size_t n = candidates.size();
  std::vector<double> expected(n);
  for (std::size_t i = 0; i < n; ++i)
    expected[i] = expected_weight(candidates[i] < counts.size() ? counts[candidates[i]] : 0);
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  for (double& value : expected) value *= static_cast<double>(kSamples) / total;
  std::vector<double> observed(n, 0.0);
  Random random(seed);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const std::size_t index = choose_candidate(candidates, counts, random.uniform_float());
    ASSERT_LT(index, n);
    observed[index] += 1.0;
  }
  EXPECT_TRUE(accepts(chi_square_test(observed, expected), sidak(kSignificance, kTests)));
}

std::vector<std::uint32_t> every_third_triangle() {
  std::vector<std::uint32_t> candidates(kCandidates);
  for (std::uint32_t i = 0; i < kCandidates; ++i) candidates[i] = 3 * i;
  return candidates;
}

TEST(TrainingCounts, WeightIsTheInverseOfTheCountClampedTo1And512) {
  EXPECT_EQ(training_weight(0), 1.0f);
  EXPECT_EQ(training_weight(1), 1.0f);
  EXPECT_EQ(training_weight(2), 0.5f);
  EXPECT_EQ(training_weight(511), 1.0f / 511.0f);
  EXPECT_EQ(training_weight(512), 1.0f / 512.0f);
  EXPECT_EQ(training_weight(513), 1.0f / 512.0f);
  EXPECT_EQ(training_weight(0xffffffffu), 1.0f / 512.0f);
}

TEST(TrainingCounts, ChoiceFollowsTheWeights) {
  std::vector<std::uint32_t> counts(3 * kCandidates);
  for (std::uint32_t i = 0; i < counts.size(); ++i) counts[i] = i % 7;
  counts[3] = 400;
  counts[6] = 100000;
  expect_choices_by_weight(every_third_triangle(), counts, 1);
  // A candidate that is named twice has twice the chance, and one outside the counts is untrained.
  expect_choices_by_weight({5, 2, 5, 1}, {9, 1, 4, 9, 9, 2}, 2);
  expect_choices_by_weight({0, 7, 1, 0xffffffffu}, {3, 512}, 3);
}

TEST(TrainingCounts, EqualCountsAreTheUniformChoiceExactly) {
  const std::vector<std::uint32_t> candidates = every_third_triangle();
  for (const std::uint32_t count : {0u, 1u, 3u, 47u, 509u, 512u, 100000u}) {
    const std::vector<std::uint32_t> counts(3 * kCandidates, count);
    for (std::uint32_t step = 0; step < 16 * kCandidates; ++step) {
      const float u = static_cast<float>(step) / (16 * kCandidates);
      EXPECT_EQ(choose_candidate(candidates, counts, u), step / 16) << "count " << count;
    }
    EXPECT_EQ(choose_candidate(candidates, counts, 0x1.fffffep-1f), kCandidates - 1);
  }
}

TEST(TrainingCounts, ASingleCandidateIsChosen) {
  const std::array<std::uint32_t, 1> candidate = {4};
  for (const float u : {0.0f, 0.5f, 0x1.fffffep-1f}) EXPECT_EQ(choose_candidate(candidate, {}, u), 0u);
}

}  // namespace
}  // namespace gatelight::neural
