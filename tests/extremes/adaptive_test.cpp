// Adaptive sampling: brightness of any scale, bright samples, tiny pictures.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/run/adaptive_sampling.h"
#include "tests/extremes/extreme.h"
#include "tests/renderer/reconstruction/made_picture.h"

namespace gatelight::renderer {
namespace {

using testing::tell_extreme;

SampleDensity density_of(const Reconstruction& finished, int width, int height) {
  const SampleDensity density = make_density({0, 0, width, height}, finished);
  for (const std::vector<float>& half : density.values()) {
    for (const float v : half) EXPECT_TRUE(v >= 0.0f && v <= SampleDensity::kMost) << v;
  }
  return density;
}

TEST(AdaptiveSampling, IsTheSameForLightOfAnyScale) {
  const Reconstruction finished = reconstruct(make_picture(60, 40, 8, 1.0).samples);
  const SampleDensity expected = density_of(finished, 60, 40);
  double worst = 0.0;
  for (const float scale : {1e-30f, 1e-6f, 1e6f, 1e30f}) {
    Reconstruction scaled = finished;
    for (const std::size_t h : {0u, 1u}) {
      for (float& v : scaled.halves[h]) v *= scale;
      for (float& v : scaled.noise[h]) v *= scale;
    }
    const SampleDensity density = density_of(scaled, 60, 40);
    for (const std::size_t h : {0u, 1u}) {
      for (std::size_t p = 0; p < density.values()[h].size(); ++p) {
        worst = std::max(worst, std::abs(static_cast<double>(density.values()[h][p]) /
                                             static_cast<double>(expected.values()[h][p]) -
                                         1.0));
      }
    }
  }
  EXPECT_LT(worst, 1e-4);
  tell_extreme("radiance of 1e-30 to 1e30 times its value", "density of samples, 60x40",
               fmt::format("the same within {:.0e} (bound 1e-4)", worst), "");
}

TEST(AdaptiveSampling, OneBrightSampleTakesNoMoreThanItsShare) {
  Reconstruction finished = reconstruct(make_picture(60, 40, 8, 1.0).samples);
  double most = 0.0;
  for (const float bright : {1e4f, 1e12f, 1e30f, 3e38f}) {
    finished.noise[0][20 * 60 + 30] = bright;
    const SampleDensity density = density_of(finished, 60, 40);
    double sum = 0.0;
    for (int y = 17; y <= 23; ++y) {
      for (int x = 27; x <= 33; ++x)
        sum += static_cast<double>(density.values()[1][static_cast<std::size_t>(60 * y + x)]);
    }
    most = std::max(most, sum / (60 * 40));
  }
  // It is one of 49 pixels that follow it, and no pixel gets more than 32 times the least.
  EXPECT_LT(most, 0.41);
  tell_extreme("one sample of 1e4 to 3e38", "density of samples, 60x40",
               fmt::format("at most {:.0f} % of them go to its neighbours (bound 41 %)", 100.0 * most), "");
}

TEST(AdaptiveSampling, TinyPicturesAndFewSamples) {
  int tried = 0;
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {2, 3}, {17, 1}}) {
    for (const int spp : {1, 2, 3}) {
      density_of(reconstruct(make_picture(width, height, spp, 1.0).samples), width, height);
      ++tried;
    }
  }
  tell_extreme("tiny pictures of few samples",
               fmt::format("{} densities, 1x1 to 17x1, 1 to 3 samples", tried),
               "0 to 64 samples a pixel and pass", "");
}

}  // namespace
}  // namespace gatelight::renderer
