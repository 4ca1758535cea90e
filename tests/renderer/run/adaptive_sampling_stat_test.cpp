// Samples go where the finished picture has noise, and the mean stays what it is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/run/adaptive_sampling.h"
#include "renderer/run/finished_picture.h"
#include "renderer/settings/resolved_options.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;

constexpr int kSide = 16;

RenderOptions adaptive_options() {
  RenderOptions options;
  options.reconstruct = true;
  return options;
}

/// Rare light on a wall: once in 25 samples it is 200 times as bright as usual.
float rare_light(const PixelSample& s, std::uint32_t seed) {
  const std::uint32_t h = hash(
      hash(hash(hash(seed) + static_cast<std::uint32_t>(s.pixel.x)) + static_cast<std::uint32_t>(s.pixel.y)) +
      s.number);
  return h < 0xffffffffu / 25 ? 20.0f : 0.1f;
}
constexpr double kRareLightMean = (20.0 + 24.0 * 0.1) / 25.0;

class Wall {
 public:
  Wall(std::uint32_t seed)
      : film_({0, 0, kSide, kSide}, kSide, kSide, film_aovs(adaptive_options())), seed_(seed) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) pixels_.push_back({x, y});
    }
  }
  Film& film() { return film_; }
  void run_pass() {
    film_.take_pass(pixels_, 0, samples_);
    FirstHit first;
    first.guide.hit = true;
    first.guide.albedo.setConstant(0.5f);
    first.guide.normal = {0.0f, 0.0f, 1.0f};
    first.guide.depth = 1.0f;
    for (const PixelSample& s : samples_) {
      film_.add(s, first);
      film_.add(s, Color(Color::Constant(rare_light(s, seed_))));
    }
    film_.end_passes(1);
  }
  double mean() const {
    const std::vector<float> values = film_.resolve().layers.front().values;
    double sum = 0.0;
    for (const float v : values) sum += static_cast<double>(v);
    return sum / static_cast<double>(values.size());
  }

 private:
  Film film_;
  std::uint32_t seed_;
  std::vector<Pixel> pixels_;
  std::vector<PixelSample> samples_;
};

/// Means of many walls, whose density is made after 2, 8 and 32 samples.
Moments means_of_walls(const std::function<void(Film&, int)>& adapt) {
  Moments means;
  for (std::uint32_t seed = 0; seed < 4000; ++seed) {
    Wall wall(seed);
    for (int pass = 0; pass < 24; ++pass) {
      adapt(wall.film(), pass);
      wall.run_pass();
    }
    means.add(wall.mean());
  }
  return means;
}

Reconstruction finished(const Film& film) {
  return reconstruction_of(film.resolve(), SharedRows::all(film.rect().height()), adaptive_options());
}

TEST(AdaptiveSampling, KeepsTheMeanOfRareLight) {
  const Moments means = means_of_walls([&](Film& film, int samples) {
    if (density_due(film, samples, adaptive_options()))
      film.follow(make_density(film.rect(), finished(film)));
  });
  EXPECT_LT(means.standard_error(), 0.001 * kRareLightMean);
  EXPECT_GT(testing::mean_p_value(means, kRareLightMean), 1e-3)
      << means.mean() << " +- " << means.standard_error() << ", expected " << kRareLightMean;
}

/// What the test above would see if each half had its samples by its own noise.
TEST(AdaptiveSampling, ByAHalfsOwnNoiseTheMeanWouldBeTooSmall) {
  const Moments means = means_of_walls([&](Film& film, int samples) {
    if (samples != 2 && samples != 8) return;
    Reconstruction swapped = finished(film);
    std::swap(swapped.halves[0], swapped.halves[1]);
    std::swap(swapped.noise[0], swapped.noise[1]);
    film.follow(make_density(film.rect(), swapped));
  });
  EXPECT_LT(means.mean(), kRareLightMean - 4.0 * means.standard_error());
}

TEST(AdaptiveSampling, DensitiesAreMadeAfterSoManySamples) {
  RenderOptions options = adaptive_options();
  EXPECT_EQ(next_density(options, 0), 2);
  EXPECT_EQ(next_density(options, 1), 2);
  EXPECT_EQ(next_density(options, 2), 8);
  EXPECT_EQ(next_density(options, 100), 128);
  EXPECT_EQ(next_density(options, std::numeric_limits<int>::max() - 1), std::numeric_limits<int>::max());
  options.adaptive = false;
  EXPECT_EQ(next_density(options, 0), std::numeric_limits<int>::max());
}

/// Two walls side by side, one of which has no noise: nearly all samples go to the other one, by the noise of
/// either half.
TEST(AdaptiveSampling, SamplesGoWhereNoiseIsLeft) {
  constexpr std::size_t kPixels = 64 * 32;
  Reconstruction finished;
  for (const std::size_t h : {0u, 1u}) {
    finished.halves[h].assign(3 * kPixels, 1.0f);
    finished.noise[h].resize(kPixels);
    for (std::size_t p = 0; p < kPixels; ++p)
      finished.noise[h][p] = p % 64 < 32 ? 0.0f : (h == 0 ? 0.1f : 1e-3f * static_cast<float>(1 + p / 64));
  }
  const SampleDensity density = make_density({0, 0, 64, 32}, finished);
  const auto value = [&](std::size_t half, std::size_t x, std::size_t y) {
    return density.values()[half][64 * y + x];
  };
  for (const std::size_t half : {0u, 1u}) EXPECT_LT(3.0f * value(half, 8, 16), value(half, 56, 16));
  // The second half follows the first one's noise, which is the same everywhere, and the other way round.
  EXPECT_FLOAT_EQ(value(1, 56, 4), value(1, 56, 28));
  EXPECT_LT(1.5f * value(0, 56, 4), value(0, 56, 28));
  // Brightness hides noise.
  for (std::vector<float>& half : finished.halves) std::fill(half.begin() + 3 * 64 * 16, half.end(), 10.0f);
  const SampleDensity hidden = make_density({0, 0, 64, 32}, finished);
  EXPECT_GT(hidden.values()[1][64 * 4 + 56], 1.5f * hidden.values()[1][64 * 28 + 56]);
}

TEST(AdaptiveSampling, APictureWithoutNoiseOrLightIsEven) {
  Reconstruction black;
  for (const std::size_t h : {0u, 1u}) black.halves[h].assign(3 * 64, 0.0f), black.noise[h].assign(64, 0.0f);
  const SampleDensity density = make_density({0, 0, 8, 8}, black);
  for (const std::vector<float>& half : density.values()) {
    for (const float v : half) EXPECT_EQ(v, 1.0f);
  }
}

}  // namespace
}  // namespace gatelight::renderer
