#include "renderer/denoise/denoiser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/denoise/exposure.h"
#include "renderer/settings/enum_names.h"
#include "tests/support/denoiser.h"
#include "tests/support/noisy_image.h"

namespace gatelight::renderer {
namespace {

using testing::clean_image;
using testing::deviation;
using testing::noisy_image;

class Denoisers : public ::testing::Test {
 protected:
  void SetUp() override { GATELIGHT_NEEDS_DENOISER(); }
  NoisyImage filtered(NoisyImage image, const FilterOptions& options = {}, int threads = 2) const {
    EXPECT_TRUE(Denoiser(load_oidn(testing::denoiser_place()), threads).filter(image, options));
    return image;
  }
};

TEST_F(Denoisers, RemoveMostOfTheNoiseAndKeepEdges) {
  const NoisyImage clean = clean_image(96, 64), noisy = noisy_image(96, 64);
  const double before = deviation(noisy.color, clean.color);
  for (const Prefilter prefilter : {Prefilter::accurate, Prefilter::none, Prefilter::fast}) {
    for (const DenoiseQuality quality : {DenoiseQuality::fast, DenoiseQuality::high}) {
      const NoisyImage denoised = filtered(noisy, {.prefilter = prefilter, .quality = quality});
      EXPECT_LT(deviation(denoised.color, clean.color), 0.15 * before) << enum_name(prefilter);
      // Guides are filtered in place, or stay as they are.
      EXPECT_EQ(denoised.albedo == noisy.albedo, prefilter != Prefilter::accurate);
    }
  }
  NoisyImage alone = noisy;
  alone.albedo.clear();
  alone.normal.clear();
  EXPECT_LT(deviation(filtered(alone).color, clean.color), 0.3 * before) << "without guides";
}

TEST_F(Denoisers, HaveTheSameBitsForAnyNumberOfThreads) {
  const NoisyImage noisy = noisy_image(130, 70);
  const NoisyImage one = filtered(noisy, {}, 1);
  for (const int threads : {2, 3}) EXPECT_EQ(filtered(noisy, {}, threads).color, one.color) << threads;
}

TEST_F(Denoisers, DoNotDependOnTheUnitOfLight) {
  const NoisyImage noisy = noisy_image(96, 64);
  const auto scaled = [&](float unit) {
    NoisyImage image = noisy;
    for (float& value : image.color) value *= unit;
    const float scale = exposure_of(image.width, image.height, testing::rows_of(image.color, image.width));
    image = filtered(image, {.scale = scale});
    for (float& value : image.color) value /= unit;
    return image.color;
  };
  const std::vector<float> usual = scaled(1.0f);
  for (const float unit : {0x1p-60f, 0x1p-20f, 0x1p40f})
    EXPECT_LT(deviation(scaled(unit), usual), 1e-3) << unit;
}

TEST_F(Denoisers, WorkWithLittleMemory) {
  const NoisyImage clean = clean_image(300, 200);
  NoisyImage image = noisy_image(300, 200);
  const double before = deviation(image.color, clean.color);
  EXPECT_TRUE(Denoiser(load_oidn(testing::denoiser_place()), 2, 1).filter(image, {}));
  EXPECT_LT(deviation(image.color, clean.color), 0.15 * before);
}

TEST_F(Denoisers, AcceptTheSmallestImages) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 40}, {40, 1}, {0, 0}}) {
    const NoisyImage image = filtered(noisy_image(width, height));
    for (const float value : image.color) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(Exposure, BringsTheGeometricMeanToMiddleGrey) {
  // Bins of 16 rows: one of 4, one of 1, one that is black and does not count.
  const auto rows = [](float unit) {
    return [unit](int first, int end) {
      std::vector<float> color;
      for (int y = first; y < end; ++y)
        color.insert(color.end(), 3 * 16, y < 16 ? 4.0f * unit : y < 32 ? unit : 0.0f);
      return color;
    };
  };
  EXPECT_NEAR(exposure_of(16, 48, rows(1.0f)), 0.18f / 2.0f, 1e-6f);
  for (const float unit : {1e-20f, 1e20f}) EXPECT_NEAR(exposure_of(16, 48, rows(unit)) * unit, 0.09f, 1e-5f);
  EXPECT_EQ(exposure_of(16, 48, rows(0.0f)), 1.0f);
}

}  // namespace
}  // namespace gatelight::renderer
