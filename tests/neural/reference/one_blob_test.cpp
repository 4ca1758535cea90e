#include "neural/reference/one_blob.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace gatelight::neural::reference {
namespace {

std::vector<double> blob(double x, bool wraps, std::size_t bins) {
  std::vector<double> result(bins);
  one_blob(x, wraps, result);
  return result;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

constexpr std::size_t kBins[] = {2, 4, 8, 16, 64};

TEST(OneBlob, KernelsIntegralMatchesItsClosedForm) {
  // 15/16 (1 - u^2)^2, summed by the midpoint rule.
  EXPECT_EQ(quartic_cdf(-1.0), 0.0);
  EXPECT_EQ(quartic_cdf(-5.0), 0.0);
  EXPECT_EQ(quartic_cdf(0.0), 0.5);
  EXPECT_DOUBLE_EQ(quartic_cdf(1.0), 1.0);
  EXPECT_DOUBLE_EQ(quartic_cdf(1e300), 1.0);
  constexpr int kSteps = 20000;
  double integral = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = -1.0 + 2.0 * (i + 0.5) / kSteps;
    integral += 15.0 / 16.0 * (1 - u * u) * (1 - u * u) * 2.0 / kSteps;
    EXPECT_NEAR(quartic_cdf(u + 1.0 / kSteps), integral, 1e-8);
  }
}

TEST(OneBlob, BinsAreIntegralsOfTheBump) {
  // k = 4, x = 3/8: the bump covers [1/8, 5/8]; its middle lies in the middle of bin 1.
  const double half = 2.0 * (quartic_cdf(0.5) - 0.5);
  const std::vector<double> bins = blob(0.375, false, 4);
  EXPECT_NEAR(bins[1], half, 1e-15);
  EXPECT_NEAR(bins[0], 0.5 * (1 - half), 1e-15);
  EXPECT_NEAR(bins[2], 0.5 * (1 - half), 1e-15);
  EXPECT_EQ(bins[3], 0.0);
}

TEST(OneBlob, WrappedBinsSumToOneEverywhere) {
  for (const std::size_t k : kBins)
    for (int i = -50; i <= 150; ++i) EXPECT_NEAR(sum(blob(i / 100.0, true, k)), 1.0, 1e-14);
}

TEST(OneBlob, UnwrappedBinsSumToOneInsideAndToLessAtTheBorder) {
  for (const std::size_t k : kBins) {
    const double width = 1.0 / static_cast<double>(k);
    for (int i = 0; i <= 100; ++i) {
      const double x = i / 100.0, total = sum(blob(x, false, k));
      if (x >= width && x <= 1 - width) {
        EXPECT_NEAR(total, 1.0, 1e-14);
      } else {
        EXPECT_NEAR(total, quartic_cdf((1 - x) / width) - quartic_cdf(-x / width), 1e-14);
      }
    }
    EXPECT_NEAR(sum(blob(0.0, false, k)), 0.5, 1e-15);
  }
}

TEST(OneBlob, WrappedBinsShiftWithTheirInput) {
  for (const std::size_t k : kBins) {
    const std::vector<double> here = blob(0.3, true, k);
    const std::vector<double> turned = blob(0.3 + 1.0 / static_cast<double>(k), true, k);
    for (std::size_t b = 0; b < k; ++b) EXPECT_NEAR(turned[(b + 1) % k], here[b], 1e-14);
  }
}

}  // namespace
}  // namespace gatelight::neural::reference
