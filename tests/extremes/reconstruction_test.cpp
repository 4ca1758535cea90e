// Reconstruction: sizes, darkness, bright samples, missing samples.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/reconstruction/reconstruct.h"
#include "renderer/reconstruction/region.h"
#include "tests/extremes/extreme.h"
#include "tests/renderer/reconstruction/made_picture.h"

namespace gatelight::renderer {
namespace {

using testing::tell_extreme;

TEST(Reconstruction, HasEverySizeAndNumberOfSamples) {
  int tried = 0;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}, {5, 70}, {33, 17}, {400, 2}, {16384, 3}, {3, 8192}}) {
    SCOPED_TRACE(::testing::Message() << width << "x" << height);
    for (const int spp : {1, 2, 3, 64}) {
      const Made made = make_picture(width, height, spp, 1.0);
      expect_a_picture(reconstruct(made.samples), made.samples.counts.size());
      ++tried;
    }
  }
  tell_extreme("size of a picture",
               fmt::format("{} pictures: 1x1, 16384x3, 3x8192 and between; 1, 2, 3 and 64 samples", tried),
               "every value is finite and not negative", "");
}

TEST(Reconstruction, BlackStaysBlack) {
  for (const int spp : {1, 2, 16}) {
    SampledPicture samples = make_picture(40, 30, spp, 1.0).samples;
    for (auto& half : samples.halves) {
      half.color.assign(half.color.size(), 0.0f);
      half.variance.assign(half.variance.size(), 0.0f);
    }
    const Reconstruction result = reconstruct(samples);
    expect_a_picture(result, samples.counts.size());
    for (const float value : result.color) ASSERT_EQ(value, 0.0f);
  }
  tell_extreme("all black", "1, 2 and 16 samples", "black, without NaN", "");
}

TEST(Reconstruction, OneBrightSampleChangesItsNeighbourhoodAlone) {
  const Made made = make_picture(160, 120, 8, 0.5);
  const Reconstruction clean = reconstruct(made.samples);
  double worst = 0.0;
  for (const float bright : {1e4f, 1e12f, 1e30f}) {
    SampledPicture samples = made.samples;
    samples.halves[0].color[3 * (60 * 160 + 80)] = bright / 4.0f;
    samples.halves[0].variance[3 * (60 * 160 + 80)] =
        static_cast<float>(std::min(static_cast<double>(bright) * static_cast<double>(bright) / 16.0, 3e38));
    const Reconstruction result = reconstruct(samples);
    expect_a_picture(result, samples.counts.size());
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        if (std::abs(x - 80) <= kHalo && std::abs(y - 60) <= kHalo) continue;
        const auto i = 3 * static_cast<std::size_t>(y * 160 + x);
        worst = std::max(worst, std::abs(static_cast<double>(result.color[i] - clean.color[i])));
      }
    }
  }
  EXPECT_LT(worst, 1e-4);
  tell_extreme("one bright sample", "1e4, 1e12 and 1e30 in a picture of 1",
               fmt::format("beyond {} pixels nothing changes by more than {:.1e} (bound 1e-4)", kHalo, worst),
               "");
}

TEST(Reconstruction, PixelsWithoutSamplesAreFilled) {
  Made made = make_picture(80, 60, 16, 0.5);
  for (std::size_t p = 0; p < made.samples.counts.size(); p += 2) {
    made.samples.counts[p] = 0.0f;
    for (auto& half : made.samples.halves) {
      for (std::size_t c = 0; c < 3; ++c) half.color[3 * p + c] = half.variance[3 * p + c] = 0.0f;
    }
  }
  const Reconstruction result = reconstruct(made.samples);
  expect_a_picture(result, made.samples.counts.size());
  double squares = 0.0, light = 0.0;
  for (std::size_t i = 0; i < made.truth.size(); ++i) {
    const double e = static_cast<double>(result.color[i]) - made.truth[i];
    squares += e * e;
    light += made.truth[i] * made.truth[i];
  }
  const double error = std::sqrt(squares / light);
  EXPECT_LT(error, 0.1);
  tell_extreme("pixels without finite samples", "every second pixel of 80x60, 16 samples of the others",
               fmt::format("they are filled: relative error of all pixels {:.2g} (bound 0.1)", error), "");
}

}  // namespace
}  // namespace gatelight::renderer
