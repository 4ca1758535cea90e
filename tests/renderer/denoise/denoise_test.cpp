// The denoiser, and pictures denoised band by band.

#include "renderer/denoise/denoise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "renderer/denoise/denoise_time.h"
#include "renderer/denoise/denoiser.h"
#include "renderer/denoise/exposure.h"
#include "renderer/settings/enum_names.h"
#include "tests/support/denoiser.h"
#include "tests/support/noisy_image.h"

namespace gatelight::renderer {
namespace {

using testing::clean_image;
using testing::deviation;
using testing::noisy_image;
using testing::rows_of;

NoisyPicture picture_of(const NoisyImage& image) {
  return {image.width, image.height, rows_of(image.color, image.width), rows_of(image.albedo, image.width),
          rows_of(image.normal, image.width)};
}

class DenoisedPictures : public ::testing::Test {
 protected:
  void SetUp() override {
    GATELIGHT_NEEDS_DENOISER();
    denoiser = std::make_unique<Denoiser>(load_oidn(testing::denoiser_place()), 2);
  }

  std::vector<float> denoised(const NoisyImage& image) const {
    const auto result = denoise(*denoiser, picture_of(image), {}, ScaleDown(1, PixelFilter::box, 0.0f));
    EXPECT_TRUE(result);
    EXPECT_EQ(result->color.size(), image.color.size());
    for (const float value : result->color) EXPECT_TRUE(std::isfinite(value) && value >= 0.0f);
    return result->color;
  }

  static NoisyImage filtered(NoisyImage image, const FilterOptions& options = {}, int threads = 2) {
    EXPECT_TRUE(Denoiser(load_oidn(testing::denoiser_place()), threads).filter(image, options));
    return image;
  }

  std::unique_ptr<Denoiser> denoiser;
};

TEST_F(DenoisedPictures, HaveNoSeamsWhereBandsMeet) {
  const NoisyImage image = noisy_image(64, 700);
  const ScaleDown as_is(1, PixelFilter::box, 0.0f);
  const auto whole = denoise_rows(*denoiser, picture_of(image), {0, 700}, {}, as_is);
  const auto upper = denoise_rows(*denoiser, picture_of(image), {0, 333}, {}, as_is);
  const auto lower = denoise_rows(*denoiser, picture_of(image), {333, 700}, {}, as_is);
  ASSERT_TRUE(whole && upper && lower);
  std::vector<float> joined = upper->color;
  joined.insert(joined.end(), lower->color.begin(), lower->color.end());
  ASSERT_EQ(joined.size(), whole->color.size());
  const NoisyImage clean = clean_image(64, 700);
  for (std::size_t i = 0; i < joined.size(); ++i) ASSERT_NEAR(joined[i], whole->color[i], 0.01f) << i;
  EXPECT_LT(deviation(joined, whole->color), 0.02 * deviation(whole->color, clean.color));
}

TEST_F(DenoisedPictures, AreScaledAfterTheyAreDenoised) {
  const NoisyImage image = noisy_image(128, 96), clean = clean_image(128, 96);
  const ScaleDown as_is(1, PixelFilter::box, 0.0f), half(2, PixelFilter::blackman_harris, 0.0f);
  const auto large = denoise(*denoiser, picture_of(image), {}, as_is);
  const auto small = denoise(*denoiser, picture_of(image), {}, half);
  ASSERT_TRUE(large && small);
  EXPECT_EQ(small->color, half.scale(large->color, 3, 128, 96, 0, 0, 48));
  EXPECT_LT(deviation(small->color, half.scale(clean.color, 3, 128, 96, 0, 0, 48)), 0.1);
}

TEST_F(DenoisedPictures, WithAnAlphaKeepItsEdges) {
  const NoisyImage image = noisy_image(96, 64);
  std::vector<float> alpha;
  std::mt19937 random(1);
  std::binomial_distribution<int> of_eight(8, 0.3);
  for (int i = 0; i < 96 * 64; ++i)
    alpha.push_back(i % 96 < 48 ? 1.0f : 0.125f * static_cast<float>(of_eight(random)));
  NoisyPicture picture = picture_of(image);
  picture.alpha = rows_of(alpha, 96, 1);
  const auto clean = denoise(*denoiser, picture, {}, ScaleDown(1, PixelFilter::box, 0.0f));
  ASSERT_TRUE(clean);
  ASSERT_EQ(clean->alpha.size(), alpha.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    const std::size_t x = i % 96;
    const float a = clean->alpha[i];
    if (x < 47) {
      ASSERT_EQ(a, 1.0f) << i << ": opaque pixels stay opaque";
    }
    if (x < 52) continue;
    sum += static_cast<double>(a);
    squares += std::pow(static_cast<double>(a) - 0.3, 2);
  }
  // Binomial numbers have this standard error; a denoiser keeps their mean.
  const double error = std::sqrt(0.3 * 0.7 / 8.0 / (44 * 64));
  EXPECT_NEAR(sum / (44 * 64), 0.3, 5.0 * error);
  EXPECT_LT(std::sqrt(squares / (44 * 64)), 0.04) << "of 0.16";
  EXPECT_EQ(clean->color,
            denoise(*denoiser, picture_of(image), {}, ScaleDown(1, PixelFilter::box, 0.0f))->color);
}

TEST_F(DenoisedPictures, CanBeCancelledInAnyBand) {
  const NoisyImage image = noisy_image(64, 64);
  const ScaleDown as_is(1, PixelFilter::box, 0.0f);
  double last = 0.0;
  const auto until = [&](double end) {
    last = 0.0;
    return [&, end](double done) {
      EXPECT_GE(done + 1e-9, last);
      last = done;
      return done < end;
    };
  };
  EXPECT_FALSE(denoise(*denoiser, picture_of(image), {}, as_is, until(0.5)));
  EXPECT_TRUE(denoise(*denoiser, picture_of(image), {}, as_is, until(2.0)));
  EXPECT_GT(last, 0.9);
}

TEST_F(DenoisedPictures, ExpectedTimeGrowsWithThePixels) {
  const double small = expect_denoise_seconds(*denoiser, {}, 256, 256);
  const double large = expect_denoise_seconds(*denoiser, {}, 2560, 2560);
  EXPECT_GT(small, 0.0);
  EXPECT_GT(large, 20.0 * small);
}

TEST_F(DenoisedPictures, OfEverySizeAreFiniteAndNotNegative) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}, {5, 70}, {33, 17}, {400, 2}, {16384, 3}, {3, 8192}}) {
    SCOPED_TRACE(::testing::Message() << width << "x" << height);
    denoised(noisy_image(width, height));
  }
}

TEST_F(DenoisedPictures, OfBlackStayBlack) {
  NoisyImage image = noisy_image(40, 30);
  image.color.assign(image.color.size(), 0.0f);
  const std::vector<float> color = denoised(image);
  EXPECT_LT(*std::max_element(color.begin(), color.end()), 1e-3f);
}

TEST_F(DenoisedPictures, OneBrightSampleChangesOnlyItsNeighbourhood) {
  constexpr int kReach = 128;
  const NoisyImage image = noisy_image(320, 280);
  const std::vector<float> clean = denoised(image);
  double worst = 0.0;
  for (const float bright : {1e4f, 1e12f, 1e30f}) {
    NoisyImage with = image;
    // The exposure of the picture counts bins of 16x16 pixels by the logarithm, so one changes it a little.
    with.color[3 * (140 * 320 + 160)] = bright;
    const std::vector<float> color = denoised(with);
    for (int y = 0; y < 280; ++y) {
      for (int x = 0; x < 320; ++x) {
        if (std::abs(x - 160) <= kReach && std::abs(y - 140) <= kReach) continue;
        const auto i = 3 * static_cast<std::size_t>(y * 320 + x);
        worst = std::max(worst, std::abs(static_cast<double>(color[i] - clean[i])));
      }
    }
  }
  EXPECT_LT(worst, 0.05);
}

TEST_F(DenoisedPictures, RemoveMostOfTheNoiseAndKeepEdges) {
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
  // Where guides are said to have no noise they stay.
  NoisyImage part = noisy;
  part.noisy_guides = PixelRect{32, 0, 96, 40};
  const NoisyImage denoised = filtered(part);
  EXPECT_LT(deviation(denoised.color, clean.color), 0.15 * before);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 96; ++x) {
      const auto i = 3 * static_cast<std::size_t>(y * 96 + x);
      if (x < 32 || y >= 40) {
        ASSERT_EQ(denoised.normal[i], noisy.normal[i]) << x << " " << y;
      }
    }
  }
  EXPECT_LT(deviation(denoised.albedo, clean.albedo), deviation(noisy.albedo, clean.albedo));
  part.noisy_guides = PixelRect{};
  EXPECT_EQ(filtered(part).albedo, noisy.albedo);
  NoisyImage alone = noisy;
  alone.albedo.clear();
  alone.normal.clear();
  EXPECT_LT(deviation(filtered(alone).color, clean.color), 0.3 * before) << "without guides";
}

TEST_F(DenoisedPictures, HaveTheSameBitsForAnyNumberOfThreads) {
  const NoisyImage noisy = noisy_image(130, 70);
  const NoisyImage one = filtered(noisy, {}, 1);
  for (const int threads : {2, 3}) EXPECT_EQ(filtered(noisy, {}, threads).color, one.color) << threads;
}

TEST_F(DenoisedPictures, DoNotDependOnTheUnitOfLight) {
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

TEST_F(DenoisedPictures, WorkWithLittleMemory) {
  const NoisyImage clean = clean_image(300, 200);
  NoisyImage image = noisy_image(300, 200);
  const double before = deviation(image.color, clean.color);
  EXPECT_TRUE(Denoiser(load_oidn(testing::denoiser_place()), 2, 1).filter(image, {}));
  EXPECT_LT(deviation(image.color, clean.color), 0.15 * before);
}

TEST_F(DenoisedPictures, AcceptTheSmallestImages) {
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
