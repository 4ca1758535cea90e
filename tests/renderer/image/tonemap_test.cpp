// The curves to the screen, and the automatic exposure of a picture.

#include "renderer/image/tonemap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "renderer/image/auto_exposure.h"
#include "tests/support/rgb_pictures.h"

namespace gatelight::renderer {

namespace {

constexpr Tonemap kCurves[] = {Tonemap::none, Tonemap::filmic, Tonemap::neutral, Tonemap::aces, Tonemap::agx};

TEST(Curves, GreysRiseStayGreyAndStayInTheScreensRange) {
  for (const Tonemap curve : kCurves) {
    float last = 0.0f;
    for (float x = 1e-6f; x < 1e30f; x *= 1.3f) {
      const Color shown = tonemapped(Color::Constant(x), curve);
      EXPECT_GE(shown.minCoeff(), last - 1e-4f) << x;
      EXPECT_LE(shown.maxCoeff(), 1.0f) << x;
      EXPECT_LT(shown.maxCoeff() - shown.minCoeff(), 2e-3f) << x;
      last = shown.minCoeff();
    }
    EXPECT_GT(last, 0.95f);
    EXPECT_LT(tonemapped(Color::Zero(), curve).maxCoeff(), 1e-3f);
  }
}

TEST(Curves, NonFiniteAndNegativeValuesStayInTheScreensRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  for (const Tonemap curve : kCurves) {
    for (const Color& color :
         {Color(nan, 1, 0), Color(-3, 0.5f, 2), Color(infinite, infinite, infinite), Color(infinite, 0, 1)}) {
      const Color shown = tonemapped(color, curve);
      EXPECT_TRUE(shown.allFinite());
      EXPECT_GE(shown.minCoeff(), 0.0f);
      EXPECT_LE(shown.maxCoeff(), 1.0f);
    }
  }
  EXPECT_EQ(filmic(infinite), 1.0f);
  EXPECT_EQ(filmic(nan), 0.0f);
}

TEST(Neutral, KeepsColoursBelowItsShoulderButForTheGlare) {
  // The specification: base colours up to 0.8 arrive as they are, after 0.04 of Fresnel reflection is taken
  // off.
  const Color color(0.5f, 0.3f, 0.7f);
  EXPECT_TRUE(tonemapped(color, Tonemap::neutral).isApprox(color - 0.04f, 1e-6f));
  EXPECT_NEAR(tonemapped(Color::Constant(0.04f), Tonemap::neutral).x(), 6.25f * 0.04f * 0.04f, 1e-6f);
  // A grey of 2, less 0.04, becomes 1 - 0.24^2 / (1.96 + 0.24 - 0.76).
  EXPECT_NEAR(tonemapped(Color::Constant(2.0f), Tonemap::neutral).x(), 0.96f, 1e-4f);
}

/// The position of the middle channel between the least and the greatest.
float hue(const Color& c) {
  return (c[1] - c[2]) / (c[0] - c[2]);
}

TEST(Neutral, KeepsHuesThatClampingShifts) {
  const Color orange(10.0f, 2.0f, 0.1f);
  EXPECT_NEAR(hue(tonemapped(orange, Tonemap::neutral)), hue(orange), 1e-3f);
  EXPECT_GT(hue(tonemapped(orange, Tonemap::none)), 0.9f) << "clamped it is yellow";
}

TEST(MiddleGrey, IsShownNearTheMiddle) {
  for (const Tonemap curve : {Tonemap::aces, Tonemap::agx, Tonemap::filmic}) {
    const float grey = tonemapped(Color::Constant(0.18f), curve).x();
    EXPECT_GT(grey, 0.09f);
    EXPECT_LT(grey, 0.28f);
  }
}

Picture of(const std::vector<float>& greys) {
  std::vector<float> values;
  for (const float grey : greys) values.insert(values.end(), 3, grey);
  return testing::rgb(static_cast<int>(greys.size()), 1, std::move(values));
}

TEST(AutoExposure, BringsTheLogAverageToMiddleGrey) {
  EXPECT_NEAR(auto_exposure(of({0.18f, 0.18f})), 0.0f, 1e-6f);
  EXPECT_NEAR(auto_exposure(of({0.045f, 0.045f})), 2.0f, 1e-6f);
  EXPECT_NEAR(auto_exposure(of({0.09f, 0.36f})), 0.0f, 1e-6f);
  EXPECT_NEAR(auto_exposure(of({0.045f, 0.0f, 0.0f})), 2.0f, 1e-6f) << "black pixels do not count";
}

TEST(AutoExposure, LimitsBrightPartsAndIsZeroWithoutLight) {
  // A tenth of the picture is a window of 100 times the rest.
  std::vector<float> room(100, 0.02f);
  std::fill_n(room.begin(), 10, 20.0f);
  EXPECT_NEAR(auto_exposure(of(room)), std::log2(12.0f / 20.0f), 0.051f);
  // A fifth is a floor in the sun.
  std::fill_n(room.begin(), 20, 0.6f);
  EXPECT_NEAR(auto_exposure(of(room)), std::log2(0.75f / 0.6f), 0.051f);
  // A lamp of one pixel does not count.
  room.assign(100, 0.02f);
  room[7] = 1e4f;
  EXPECT_GT(auto_exposure(of(room)), 2.5f);
  EXPECT_EQ(auto_exposure(of({0.0f, 0.0f})), 0.0f);
  EXPECT_EQ(auto_exposure(of({std::numeric_limits<float>::quiet_NaN(), -1.0f})), 0.0f);
}

}  // namespace
}  // namespace gatelight::renderer
