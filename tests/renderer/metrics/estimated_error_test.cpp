#include "renderer/metrics/estimated_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gatelight::renderer {
namespace {

struct Case {
  Picture picture{.width = 7, .height = 5};
  Layer values{.channels = {"R", "G", "B"}, .values = std::vector<float>(7 * 5 * 3, 0.0f)};
  Layer errors = values;

  double estimate(int smoothing) const { return estimated_error(picture, values, errors, smoothing); }
};

TEST(ErrorEstimate, IsRelativeToTheValue) {
  Case c;
  std::fill(c.values.values.begin(), c.values.values.end(), 2.0f);
  std::fill(c.errors.values.begin(), c.errors.values.end(), 0.5f);
  for (const int smoothing : {0, 1, 100}) {
    EXPECT_NEAR(c.estimate(smoothing), 0.5 / std::sqrt(4.0 + 1e-2), 1e-6) << smoothing;
  }
}

TEST(ErrorEstimate, IsThatOfCompareInTheDark) {
  Case c;
  EXPECT_EQ(c.estimate(2), 0.0);
  c.errors.values[4] = 1.0f;
  EXPECT_NEAR(c.estimate(0), std::sqrt(1.0 / 1e-2 / (7 * 5 * 3)), 1e-9);
}

TEST(ErrorEstimate, ABrightSampleIsRelativeToItsNeighbourhood) {
  Case c;
  const std::size_t middle = 3 * (2 * 7 + 3);
  c.values.values[middle] = 90.0f;
  c.errors.values[middle] = 90.0f;
  const double count = 7 * 5 * 3;
  EXPECT_NEAR(c.estimate(0), std::sqrt(8100.0 / (8100.0 + 1e-2) / count), 1e-6);
  EXPECT_NEAR(c.estimate(1), std::sqrt(8100.0 / (100.0 + 1e-2) / count), 1e-5);
}

TEST(ErrorEstimate, ChannelsAreSeparateAndNeighbourhoodsEndAtBorders) {
  Case c;
  c.errors.values[0] = 1.0f;     // red of the first pixel
  c.values.values[1] = 1000.0f;  // its green
  c.values.values[3] = 4.0f;     // red of the next pixel
  EXPECT_NEAR(c.estimate(1), std::sqrt(1.0 / (1.0 + 1e-2) / (7 * 5 * 3)), 1e-6)
      << "the mean of four reds is 1";
}

}  // namespace
}  // namespace gatelight::renderer
