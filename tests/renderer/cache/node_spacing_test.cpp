// Node spacings from the widths of pixels.

#include "renderer/cache/node_spacing.h"

#include <gtest/gtest.h>

#include <limits>

namespace gatelight::renderer {
namespace {

const std::vector<double> kNoArea(6, 0.0);

PixelWidths seen(const std::vector<std::vector<float>>& widths) {
  PixelWidths result(widths.size());
  for (std::uint32_t i = 0; i < widths.size(); ++i)
    for (const float width : widths[i]) result.add_seen(i, width);
  return result;
}

TEST(NodeSpacing, GrowsWithTheWidthOfAPixel) {
  const NodeSpacing found =
      seen({{1.0f, 1.0f, 9.0f}, {1.0f}, {4.0f}, {0.25f}, {1.4f}, {1.5f}}).spacing(10.0f, kNoArea);
  EXPECT_EQ(found.spacing, 14.0f) << "the middle one of all points";
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 1.0f, 4.0f, 0.25f, 1.0f, 1.0f}));
}

TEST(NodeSpacing, NothingIsMuchFinerOrCoarserThanTheRest) {
  const NodeSpacing found = seen({{1e-6f}, {1.0f, 1.0f, 1.0f}, {1e6f}}).spacing(1.0f, kNoArea);
  EXPECT_EQ(found.scales, (std::vector<float>{0x1p-7f, 1.0f, 8.0f}));
}

TEST(NodeSpacing, WhatTheCameraSeesDecidesBeforeWhatPathsMeet) {
  PixelWidths widths(4);
  widths.add_seen(0, 1.0f);
  widths.add_met(0, 64.0f);
  widths.add_met(1, 4.0f);
  for (int i = 0; i < 9; ++i) widths.add_met(2, 64.0f);
  const NodeSpacing found = widths.spacing(2.0f, kNoArea);
  EXPECT_EQ(found.spacing, 2.0f);
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 4.0f, 8.0f, 1.0f})) << "the last was not met at all";
}

TEST(NodeSpacing, LittleOfALargeThingIsNotWorthManyNodes) {
  PixelWidths widths(3);
  for (std::uint32_t instance = 0; instance < 3; ++instance)
    for (int i = 0; i < 48; ++i) widths.add_seen(instance, 1.0f);
  // 48 points are worth 144 nodes, 3 metres apart on the last one.
  const NodeSpacing found = widths.spacing(0.25f, std::vector<double>{1.0, 36.0, 1296.0});
  EXPECT_EQ(found.spacing, 0.25f);
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 2.0f, 8.0f}));
}

TEST(NodeSpacing, WhereTheCameraSeesNothingPathsDecide) {
  PixelWidths widths(2);
  widths.add_met(1, 3.0f);
  EXPECT_EQ(widths.spacing(2.0f, kNoArea).spacing, 6.0f);
}

TEST(NodeSpacing, WithoutAWidthThereIsNone) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const PixelWidths& widths :
       {PixelWidths(2), seen({{0.0f}, {0.0f}}), seen({{kInfinity}, {kInfinity}})}) {
    const NodeSpacing found = widths.spacing(10.0f, kNoArea);
    EXPECT_EQ(found.spacing, 0.0f);
    EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 1.0f}));
  }
}

}  // namespace
}  // namespace gatelight::renderer
