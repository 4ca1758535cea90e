#include "renderer/sampling/alias_table.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

const std::vector<std::vector<double>> kWeights = {{0.1},
                                                   {0.2, 0.3},
                                                   {1e-9, 1.0, 1e9, 1e9},
                                                   {0.0, 1e-3, 5.0, 0.0, 7.0, 2.0, 0.0},
                                                   {1e-30, 3e-30, 2e-30},
                                                   std::vector<double>(100, 0.25)};

double sum_of(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double w : weights) sum += w;
  return sum;
}

TEST(AliasTable, DrawsEachIndexByItsWeight) {
  for (const std::vector<double>& weights : kWeights) {
    const AliasTable table(weights);
    testing::Random random(1);
    constexpr int kSamples = 200000;
    std::vector<double> observed(weights.size(), 0.0);
    for (int i = 0; i < kSamples; ++i) observed[table.sample(random.uniform())] += 1.0;
    std::vector<double> expected;
    for (const double w : weights) expected.push_back(kSamples * w / sum_of(weights));
    EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                                 testing::sidak(1e-4, kWeights.size())));
  }
}

TEST(AliasTable, DrawsNothingOfWeightZeroAtTheEndsOfTheNumbers) {
  const std::vector<double> weights = {0.0, 1.0, 1.0, 1.0, 0.0};
  const AliasTable table(weights);
  for (int i = 0; i < 5; ++i) {
    for (const double u : {i / 5.0, (i + 1) / 5.0 - 0x1p-53}) EXPECT_GT(weights[table.sample(u)], 0.0) << u;
  }
}

TEST(AliasTable, IsEmptyWithoutAnyWeight) {
  EXPECT_TRUE(AliasTable().empty());
  EXPECT_TRUE(AliasTable(std::vector<double>{}).empty());
  EXPECT_TRUE(AliasTable(std::vector<double>{0.0, 0.0}).empty());
  EXPECT_FALSE(AliasTable(std::vector<double>{0.0, 1e-300}).empty());
}

}  // namespace
}  // namespace gatelight::renderer
