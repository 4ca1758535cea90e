#include "renderer/film/scale_down.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace gatelight::renderer {
namespace {

constexpr int kWidth = 12, kHeight = 8;

std::vector<float> ramp() {
  std::vector<float> values(kWidth * kHeight);
  std::iota(values.begin(), values.end(), 0.0f);
  return values;
}

TEST(ScaleDown, ByOneChangesNothing) {
  const ScaleDown scale(1, PixelFilter::blackman_harris, 0.0f);
  EXPECT_EQ(scale.reach(), 0);
  EXPECT_EQ(scale.scale(ramp(), 1, kWidth, kHeight, 0, 0, kHeight), ramp());
}

TEST(ScaleDown, ABoxIsTheMeanOfItsPixels) {
  const ScaleDown scale(2, PixelFilter::box, 1.0f);
  EXPECT_EQ(scale.reach(), 0);
  const std::vector<float> small = scale.scale(ramp(), 1, kWidth, kHeight, 0, 0, kHeight / 2);
  ASSERT_EQ(small.size(), 24u);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      const auto corner = static_cast<float>(2 * y * kWidth + 2 * x);
      EXPECT_FLOAT_EQ(small[static_cast<std::size_t>(6 * y + x)], corner + 0.5f * (1 + kWidth));
    }
  }
}

TEST(ScaleDown, EveryFilterKeepsAConstantAtTheBordersToo) {
  const std::vector<float> values(3 * kWidth * kHeight, 0.7f);
  for (const PixelFilter filter :
       {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian, PixelFilter::blackman_harris}) {
    const ScaleDown scale(2, filter, 0.0f);
    for (const float v : scale.scale(values, 3, kWidth, kHeight, 0, 0, kHeight / 2))
      EXPECT_NEAR(v, 0.7f, 1e-6f);
  }
}

TEST(ScaleDown, ANarrowFilterIsAsWideAsAPixel) {
  for (const float width : {0.01f, 0.49f}) {
    const ScaleDown narrow(2, PixelFilter::box, width);
    EXPECT_EQ(narrow.reach(), 0);
    EXPECT_EQ(narrow.scale(ramp(), 1, kWidth, kHeight, 0, 0, kHeight / 2),
              ScaleDown(2, PixelFilter::box, 1.0f).scale(ramp(), 1, kWidth, kHeight, 0, 0, kHeight / 2));
  }
}

TEST(ScaleDown, AStepIsBlurredByTheFilter) {
  // The filter is three small pixels wide and symmetric, so a step between two pixels has its middle there.
  std::vector<float> values(kWidth * kHeight, 0.0f);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % kWidth >= kWidth / 2 ? 1.0f : 0.0f;
  const ScaleDown scale(2, PixelFilter::blackman_harris, 0.0f);
  const std::vector<float> small = scale.scale(values, 1, kWidth, kHeight, 0, 0, 1);
  EXPECT_EQ(small[1], 0.0f);
  EXPECT_NEAR(small[2] + small[3], 1.0f, 1e-6f);
  EXPECT_GT(small[2], 0.01f);
  EXPECT_LT(small[2], 0.2f);
  EXPECT_EQ(small[4], 1.0f);
}

TEST(ScaleDown, RowsHaveTheBitsOfTheWhole) {
  const ScaleDown scale(2, PixelFilter::blackman_harris, 0.0f);
  ASSERT_EQ(scale.reach(), 2);
  const std::vector<float> all = ramp(), whole = scale.scale(all, 1, kWidth, kHeight, 0, 0, 4);
  // The small row 2 is made of the rows 2 to 7.
  const std::vector<float> part(all.begin() + 2 * kWidth, all.end());
  EXPECT_EQ(scale.scale(part, 1, kWidth, kHeight, 2, 2, 3),
            std::vector<float>(whole.begin() + 12, whole.begin() + 18));
}

}  // namespace
}  // namespace gatelight::renderer
