// Passes that give some pixels more samples than others.

#include "renderer/film/sample_density.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "renderer/film/film.h"

namespace gatelight::renderer {
namespace {

constexpr PixelRect kRect{3, 5, 35, 29};
constexpr std::size_t kPixels = 32 * 24;

Pixel pixel_of(std::size_t i) {
  return {kRect.x0 + static_cast<int>(i % 32), kRect.y0 + static_cast<int>(i / 32)};
}

std::array<std::vector<float>, 2> some_values() {
  std::array<std::vector<float>, 2> values{std::vector<float>(kPixels), std::vector<float>(kPixels)};
  for (std::size_t i = 0; i < kPixels; ++i) {
    values[0][i] = i < 100 ? 0.0f : static_cast<float>(i % 7);
    values[1][i] = 3.0f + static_cast<float>(i % 11);
  }
  return values;
}

TEST(SampleDensity, PassesAddUpToItsSharesRounded) {
  const SampleDensity density(kRect, some_values());
  constexpr std::uint64_t kPasses = 50;
  double all = 0.0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    for (const std::size_t half : {0u, 1u}) {
      const double each = 0.5 * static_cast<double>(density.values()[half][i]);
      std::uint64_t sum = 0;
      for (std::uint64_t pass = 0; pass < kPasses; ++pass) {
        const std::uint32_t count = density.count(pixel_of(i), half, pass);
        EXPECT_LT(std::abs(count - each), 1.0 + 1e-6);
        sum += count;
      }
      EXPECT_LT(std::abs(static_cast<double>(sum) - kPasses * each), 1.0 + 1e-3);
      all += static_cast<double>(sum);
    }
  }
  // A pass is one sample for each pixel on average, and half of them go to each half.
  EXPECT_NEAR(all / (kPasses * kPixels), 1.0, 0.01);
  for (const std::vector<float>& half : density.values()) {
    double sum = 0.0;
    for (const float v : half) sum += static_cast<double>(v);
    EXPECT_NEAR(sum / kPixels, 1.0, 1e-5);
  }
}

TEST(SampleDensity, OfNothingIsEven) {
  const std::vector<float> nothing(kPixels, 0.0f);
  const SampleDensity density(kRect, {nothing, nothing});
  for (std::size_t i = 0; i < kPixels; ++i) {
    for (std::uint64_t pass = 0; pass < 4; ++pass)
      EXPECT_EQ(density.count(pixel_of(i), 0, pass) + density.count(pixel_of(i), 1, pass), 1u);
  }
}

TEST(SampleDensity, APixelGetsNoMoreThanSoMany) {
  std::vector<float> one(100 * 100, 0.0f);
  one[17] = 1.0f;
  const SampleDensity density({0, 0, 100, 100}, {one, one});
  EXPECT_EQ(density.values()[0][17], SampleDensity::kMost);
  EXPECT_LE(density.count({17, 0}, 0, 3), SampleDensity::kMost);
}

TEST(SampleDensity, AFilmFollowsItFromPassToPass) {
  const Aov aovs[] = {Aov::reconstruction};
  Film film(kRect, 64, 64, aovs);
  std::vector<Pixel> pixels;
  for (std::size_t i = 0; i < kPixels; ++i) pixels.push_back(pixel_of(i));
  std::vector<PixelSample> samples;
  // Without a density: the next sample of each, even numbers to one half and odd ones to the other.
  for (std::uint32_t pass = 0; pass < 3; ++pass) {
    film.take_pass(pixels, 0, samples);
    ASSERT_EQ(samples.size(), kPixels);
    for (const PixelSample& s : samples) EXPECT_EQ(s.number, pass);
    film.end_passes(1);
  }
  const SampleDensity density(kRect, some_values());
  film.follow(density);
  EXPECT_TRUE(film.new_density());
  std::array<std::vector<std::uint32_t>, 2> next{std::vector<std::uint32_t>(kPixels, 4),
                                                 std::vector<std::uint32_t>(kPixels, 3)};
  const auto at = [](const Pixel& p) {
    return static_cast<std::size_t>((p.y - kRect.y0) * 32 + p.x - kRect.x0);
  };
  for (std::uint64_t pass = 0; pass < 6; ++pass) {
    // Two passes in one go, then ended together.
    film.take_pass(pixels, static_cast<int>(pass % 2), samples);
    std::array<std::vector<std::uint32_t>, 2> counts{std::vector<std::uint32_t>(kPixels, 0),
                                                     std::vector<std::uint32_t>(kPixels, 0)};
    for (const PixelSample& s : samples) {
      std::uint32_t& number = next[s.half()][at(s.pixel)];
      EXPECT_EQ(s.number, number);
      number += 2;
      ++counts[s.half()][at(s.pixel)];
    }
    for (std::size_t i = 0; i < kPixels; ++i) {
      for (const std::size_t half : {0u, 1u})
        EXPECT_EQ(counts[half][i], density.count(pixel_of(i), half, pass));
    }
    if (pass % 2 == 1) film.end_passes(2);
    EXPECT_EQ(film.new_density(), pass == 0);
  }
}

}  // namespace
}  // namespace gatelight::renderer
