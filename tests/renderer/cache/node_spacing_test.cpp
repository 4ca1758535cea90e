// Node spacings from the widths of pixels.

#include "renderer/cache/node_spacing.h"

#include <gtest/gtest.h>

#include <limits>

namespace gatelight::renderer {
namespace {

const std::vector<double> kNoArea(6, 0.0);

PixelWidths camera_widths(const std::vector<std::vector<float>>& widths) {
  PixelWidths result(widths.size());
  for (std::uint32_t i = 0; i < widths.size(); ++i)
    for (const float width : widths[i]) result.add_camera(i, width);
  return result;
}

TEST(NodeSpacing, GrowsWithTheWidthOfAPixel) {
  const NodeSpacing found =
      camera_widths({{1.0f, 1.0f, 9.0f}, {1.0f}, {4.0f}, {0.25f}, {1.4f}, {1.5f}}).spacing(10.0f, kNoArea);
  EXPECT_EQ(found.spacing, 14.0f) << "the median of all points";
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 1.0f, 4.0f, 0.25f, 1.0f, 1.0f}));
}

TEST(NodeSpacing, ScalesAreClamped) {
  const NodeSpacing found = camera_widths({{1e-6f}, {1.0f, 1.0f, 1.0f}, {1e6f}}).spacing(1.0f, kNoArea);
  EXPECT_EQ(found.scales, (std::vector<float>{0x1p-7f, 1.0f, 8.0f}));
}

TEST(NodeSpacing, CameraPointsTakePrecedenceOverPathPoints) {
  PixelWidths widths(4);
  widths.add_camera(0, 1.0f);
  widths.add_met(0, 64.0f);
  widths.add_met(1, 4.0f);
  for (int i = 0; i < 9; ++i) widths.add_met(2, 64.0f);
  const NodeSpacing found = widths.spacing(2.0f, kNoArea);
  EXPECT_EQ(found.spacing, 2.0f);
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 4.0f, 8.0f, 1.0f})) << "no path met the last";
}

TEST(NodeSpacing, ALargeInstanceWithFewPointsHasFewNodes) {
  PixelWidths widths(3);
  for (std::uint32_t instance = 0; instance < 3; ++instance)
    for (int i = 0; i < 48; ++i) widths.add_camera(instance, 1.0f);
  // 48 points are worth 144 nodes, 3 metres apart on the last one.
  const NodeSpacing found = widths.spacing(0.25f, std::vector<double>{1.0, 36.0, 1296.0});
  EXPECT_EQ(found.spacing, 0.25f);
  EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 2.0f, 8.0f}));
}

TEST(NodeSpacing, WithoutCameraPointsPathPointsDecide) {
  PixelWidths widths(2);
  widths.add_met(1, 3.0f);
  EXPECT_EQ(widths.spacing(2.0f, kNoArea).spacing, 6.0f);
}

TEST(NodeSpacing, WithoutAWidthThereIsNoSpacing) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const PixelWidths& widths :
       {PixelWidths(2), camera_widths({{0.0f}, {0.0f}}), camera_widths({{kInfinity}, {kInfinity}})}) {
    const NodeSpacing found = widths.spacing(10.0f, kNoArea);
    EXPECT_EQ(found.spacing, 0.0f);
    EXPECT_EQ(found.scales, (std::vector<float>{1.0f, 1.0f}));
  }
}

}  // namespace
}  // namespace gatelight::renderer
