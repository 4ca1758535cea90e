// Node spacings from the widths of pixels.

#include "renderer/cache/node_spacing.h"

#include <gtest/gtest.h>

#include <limits>

namespace gatelight::renderer {
namespace {

PixelWidths seen(const std::vector<std::vector<float>>& widths) {
  PixelWidths result(widths.size());
  for (std::uint32_t i = 0; i < widths.size(); ++i)
    for (const float width : widths[i]) result.add_seen(i, width);
  return result;
}

TEST(NodeSpacing, GrowsWithTheWidthOfAPixel) {
  const NodeSpacing found =
      seen({{1.0f, 1.0f, 9.0f}, {1.0f}, {4.0f}, {0.25f}, {1.4f}, {1.5f}}).spacing(10.0f);
  EXPECT_EQ(found.spacing, 14.0f) << "the middle one of all points";
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 1.0f, 4.0f, 0.25f, 1.0f, 1.0f}));
}

TEST(NodeSpacing, NothingIsMuchFinerOrCoarserThanTheRest) {
  const NodeSpacing found = seen({{1e-6f}, {1.0f, 1.0f, 1.0f}, {1e6f}}).spacing(1.0f);
  EXPECT_EQ(found.scales, (std::vector<float>{0x1p-7f, 1.0f, 8.0f}));
}

TEST(NodeSpacing, WhatTheCameraSeesDecidesBeforeWhatPathsMeet) {
  PixelWidths widths(4);
  widths.add_seen(0, 1.0f);
  widths.add_met(0, 64.0f);
  widths.add_met(1, 4.0f);
  for (int i = 0; i < 9; ++i) widths.add_met(2, 64.0f);
  const NodeSpacing found = widths.spacing(2.0f);
  EXPECT_EQ(found.spacing, 2.0f);
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 4.0f, 8.0f, 1.0f})) << "the last was not met at all";
}

TEST(NodeSpacing, WhereTheCameraSeesNothingPathsDecide) {
  PixelWidths widths(2);
  widths.add_met(1, 3.0f);
  EXPECT_EQ(widths.spacing(2.0f).spacing, 6.0f);
}

TEST(NodeSpacing, WithoutAWidthThereIsNone) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const PixelWidths& widths :
       {PixelWidths(2), seen({{0.0f}, {0.0f}}), seen({{kInfinity}, {kInfinity}})}) {
    const NodeSpacing found = widths.spacing(10.0f);
    EXPECT_EQ(found.spacing, 0.0f);
    EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 1.0f}));
  }
}

}  // namespace
}  // namespace gatelight::renderer
