// Outliers are told from light, and their light stays in the picture.

#include "renderer/reconstruction/outliers.h"

#include <gtest/gtest.h>

#include <random>

namespace gatelight::renderer {
namespace {

constexpr int kWidth = 90, kHeight = 80;

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y * kWidth + x);
}

/// Two halves of even light with a little noise, over a divisor with stripes.
struct OutliersTest : testing::Test {
  OutliersTest() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> light(0.5f, 1.5f);
    for (auto& plane : divisor) {
      plane.resize(at(0, kHeight));
      for (std::size_t p = 0; p < plane.size(); ++p) plane[p] = p / 7 % 2 == 0 ? 0.1f : 0.8f;
    }
    for (HalfPlanes& half : halves) {
      for (int c = 0; c < 3; ++c) {
        half.color[c].resize(at(0, kHeight));
        for (float& value : half.color[c]) value = light(random);
        half.variance[c].assign(at(0, kHeight), 0.1f);
      }
    }
  }

  void set(int half, int x, int y, float value) {
    for (int c = 0; c < 3; ++c) {
      halves[half].color[c][at(x, y)] = value;
      halves[half].variance[c][at(x, y)] = value * value;
    }
  }
  void spread() {
    for (const float pixel : spread_outliers(halves[0], halves[1], divisor, kWidth, kHeight)) lost += pixel;
  }
  double light(int c) const {
    double sum = 0.0;
    for (const HalfPlanes& half : halves) {
      for (std::size_t p = 0; p < half.color[c].size(); ++p)
        sum += static_cast<double>(half.color[c][p]) * static_cast<double>(divisor[c][p]);
    }
    return sum;
  }

  HalfPlanes halves[2];
  Plane divisor[3];
  double lost = 0.0;  ///< as told, of all channels
};

TEST_F(OutliersTest, EvenNoiseStays) {
  const HalfPlanes before = halves[0];
  spread();
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(halves[0].color[c], before.color[c]);
    EXPECT_EQ(halves[0].variance[c], before.variance[c]);
  }
}

TEST_F(OutliersTest, ABrightSampleGoesToItsNeighboursAndNoLightIsLost) {
  for (const auto& [x, y] : {std::pair{40, 40}, {0, 0}, {kWidth - 1, 3}}) set(0, x, y, 6.0f);
  double before[3];
  for (int c = 0; c < 3; ++c) before[c] = light(c);
  const float far = halves[0].color[0][at(60, 60)], near = halves[0].color[0][at(45, 45)];
  spread();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(light(c) / before[c], 1.0, 1e-5);
  EXPECT_NEAR(lost / before[0], 0.0, 1e-5);
  for (const auto& [x, y] : {std::pair{40, 40}, {0, 0}, {kWidth - 1, 3}}) {
    EXPECT_LT(halves[0].color[0][at(x, y)], 5.0f) << x << "," << y;
    EXPECT_LT(halves[0].variance[0][at(x, y)], 25.0f) << x << "," << y;
  }
  EXPECT_EQ(halves[0].color[0][at(60, 60)], far);
  EXPECT_GT(halves[0].color[0][at(45, 45)], near);
  EXPECT_LT(halves[0].color[0][at(45, 45)], 1.2f * near);
}

TEST_F(OutliersTest, WhatBothHalvesKnowIsLight) {
  set(0, 40, 40, 60.0f);
  set(1, 41, 40, 50.0f);
  spread();
  EXPECT_EQ(halves[0].color[0][at(40, 40)], 60.0f);
  EXPECT_EQ(halves[1].color[0][at(41, 40)], 50.0f);
}

TEST_F(OutliersTest, WhatIsThereOftenIsLight) {
  // One sample of eight, of which the halves see different pixels.
  for (int y = 0; y < kHeight; y += 2) {
    for (int x = 0; x < kWidth; x += 2) set((x / 2 + y / 2) % 2, x, y, 20.0f);
  }
  spread();
  EXPECT_EQ(halves[0].color[0][at(42, 42)], 20.0f);
}

TEST_F(OutliersTest, WhatWouldBeSeenAsASquareIsLostAndTold) {
  const float beside = halves[0].color[0][at(41, 41)];
  set(0, 40, 40, 1e6f);
  double before = 0.0, after = 0.0;
  for (int c = 0; c < 3; ++c) before += light(c);
  spread();
  for (int c = 0; c < 3; ++c) after += light(c);
  EXPECT_NEAR(lost / (before - after), 1.0, 1e-5);
  EXPECT_GT(lost, 0.9 * before);
  EXPECT_GT(halves[0].color[0][at(41, 41)], 1.01f * beside);
  EXPECT_LT(halves[0].color[0][at(41, 41)], 1.03f * beside);
}

TEST_F(OutliersTest, ABlackPictureKeepsNothingAside) {
  for (HalfPlanes& half : halves) {
    for (Plane& plane : half.color) plane.assign(plane.size(), 0.0f);
  }
  set(0, 40, 40, 60.0f);
  spread();
  for (const HalfPlanes& half : halves) {
    for (const float value : half.color[1]) ASSERT_TRUE(value >= 0.0f && value <= 60.0f);
  }
}

}  // namespace
}  // namespace gatelight::renderer
