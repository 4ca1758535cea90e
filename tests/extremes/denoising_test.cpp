// Denoising: sizes, darkness, bright samples.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/denoise/denoise.h"
#include "tests/support/denoiser.h"
#include "tests/support/noisy_image.h"

namespace gatelight::renderer {
namespace {

using testing::noisy_image;

class Denoising : public ::testing::Test {
 protected:
  void SetUp() override { GATELIGHT_NEEDS_DENOISER(); }

  static std::vector<float> denoised(const NoisyImage& image) {
    static Denoiser denoiser(load_oidn(testing::denoiser_place()), 2);
    const auto rows = [&image](const std::vector<float>& plane) -> ReadRows {
      return [&plane, row = static_cast<std::ptrdiff_t>(3) * image.width](int first, int end) {
        return std::vector<float>(plane.begin() + first * row, plane.begin() + end * row);
      };
    };
    const auto color = denoise(
        denoiser, {image.width, image.height, rows(image.color), rows(image.albedo), rows(image.normal)}, {},
        ScaleDown(1, PixelFilter::box, 0.0f));
    EXPECT_TRUE(color);
    EXPECT_EQ(color->color.size(), image.color.size());
    for (const float value : color->color) {
      EXPECT_TRUE(std::isfinite(value));
      EXPECT_GE(value, 0.0f);
    }
    return color->color;
  }
};

TEST_F(Denoising, EverySizeGivesFiniteNonNegativeValues) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}, {5, 70}, {33, 17}, {400, 2}, {16384, 3}, {3, 8192}}) {
    SCOPED_TRACE(::testing::Message() << width << "x" << height);
    denoised(noisy_image(width, height));
  }
}

TEST_F(Denoising, BlackStaysBlack) {
  NoisyImage image = noisy_image(40, 30);
  image.color.assign(image.color.size(), 0.0f);
  const std::vector<float> color = denoised(image);
  EXPECT_LT(*std::max_element(color.begin(), color.end()), 1e-3f);
}

TEST_F(Denoising, OneBrightSampleChangesOnlyItsNeighbourhood) {
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

}  // namespace
}  // namespace gatelight::renderer
