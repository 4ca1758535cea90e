// Reconstruction of pictures whose truth is known: two surfaces under smooth light, and samples of it.

#include "renderer/reconstruction/reconstruct.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "neural/simd/isa.h"
#include "renderer/image/image_read.h"
#include "renderer/reconstruction/region.h"
#include "tests/renderer/reconstruction/made_picture.h"

namespace gatelight::renderer {
namespace {

template <class Values>
double squared_error(const Values& values, const std::vector<double>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double e = static_cast<double>(values[i]) - truth[i];
    sum += e * e;
  }
  return sum / static_cast<double>(truth.size());
}

double sum_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum;
}

TEST(Reconstruct, IsCloserToTheTruthThanTheSamples) {
  for (const auto& [spp, times] : {std::pair{1, 4.0}, {2, 8.0}, {3, 8.0}, {4, 8.0}, {16, 8.0}, {64, 8.0}}) {
    const Made made = make_picture(120, 90, spp, 1.5);
    const Reconstruction result = reconstruct(made.samples);
    const double before = squared_error(made.mean, made.truth);
    const double after = squared_error(result.color, made.truth);
    EXPECT_GT(before / after, times) << spp << " samples";
    RecordProperty("times_" + std::to_string(spp), std::to_string(before / after));
  }
}

TEST(Reconstruct, ErrorsAreEstimated) {
  for (const int spp : {4, 16, 64, 256}) {
    for (const double stripes : {0.0, 0.3}) {
      const Made made = make_picture(120, 90, spp, 1.0, stripes);
      const Reconstruction result = reconstruct(made.samples);
      double estimated = 0.0;
      for (const float e : result.error) estimated += static_cast<double>(e) * static_cast<double>(e);
      estimated /= static_cast<double>(result.error.size());
      const double ratio = std::sqrt(estimated / squared_error(result.color, made.truth));
      EXPECT_GT(ratio, 1.0 / 1.5) << spp << " samples, stripes " << stripes;
      // Bright samples that were kept out still count in the estimate, and with few samples the noise of the
      // estimate itself.
      EXPECT_LT(ratio, spp == 4 ? 2.5 : 1.8) << spp << " samples, stripes " << stripes;
    }
  }
}

/// But for what both have in common: detail that is smoothed, a greater part of what is left as samples grow.
TEST(Reconstruct, HalfTheDifferenceOfTheHalvesIsTheErrorOfTheirMean) {
  for (const auto& [spp, most] : {std::pair{4, 1.6}, {16, 1.6}, {64, 3.0}, {256, 3.0}}) {
    const Made made = make_picture(120, 90, spp, 1.5);
    const Reconstruction result = reconstruct(made.samples);
    double differences = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < made.truth.size(); ++i) {
      const double a = result.halves[0][i], b = result.halves[1][i];
      differences += 0.25 * (a - b) * (a - b) / static_cast<double>(made.truth.size());
      mean = std::max(mean, std::abs(0.5 * (a + b) - static_cast<double>(result.color[i])));
    }
    const double ratio = squared_error(result.color, made.truth) / differences;
    EXPECT_GT(ratio, 0.8) << spp << " samples";
    EXPECT_LT(ratio, most) << spp << " samples";
    EXPECT_LT(mean, 1e-4) << "the picture is their mean";
  }
}

TEST(Reconstruct, GoesToTheSamplesAsTheyGrow) {
  // The stripes are in no guide: blurring them is worse than the noise that is left.
  for (const int spp : {16, 64, 1024, 8192}) {
    const Made made = make_picture(64, 48, spp, 0.5, 0.5);
    const Reconstruction result = reconstruct(made.samples);
    EXPECT_LT(squared_error(result.color, made.truth), squared_error(made.mean, made.truth))
        << spp << " samples";
  }
}

/// The truth, and other light beside it: what a cache that learned a little would say.
std::vector<float> cache_of(const Made& made, double error) {
  std::vector<float> cache;
  for (std::size_t i = 0; i < made.truth.size(); ++i) {
    const double waves =
        std::sin(0.2 * static_cast<double>(i / 3 % static_cast<std::size_t>(made.samples.width)));
    cache.push_back(static_cast<float>(made.truth[i] * 0.8 * (1.0 + error * waves)));
  }
  return cache;
}

void show_cache(SampledPicture& samples, const std::vector<float>& cache) {
  for (SampledPicture::Half& half : samples.halves) half.cache = cache;
}

TEST(Reconstruct, ACacheShowsWhatNoOtherGuideTells) {
  for (const int spp : {1, 4, 16, 64}) {
    Made made = make_picture(120, 90, spp, 1.0, 0.6);
    const double without = squared_error(reconstruct(made.samples).color, made.truth);
    show_cache(made.samples, cache_of(made, 0.05));
    const double with = squared_error(reconstruct(made.samples).color, made.truth);
    EXPECT_LT(with, (spp == 1 ? 1.0 : 0.7) * without) << spp << " samples";
    RecordProperty("share_" + std::to_string(spp), std::to_string(with / without));
    // One that knows nothing does little harm.
    show_cache(made.samples, std::vector<float>(made.truth.size(), 0.3f));
    EXPECT_LT(squared_error(reconstruct(made.samples).color, made.truth), (spp == 1 ? 1.2 : 1.1) * without)
        << spp << " samples";
  }
}

TEST(Reconstruct, ANoisyCacheIsBelievedLess) {
  Made made = make_picture(120, 90, 16, 1.0, 0.6);
  const double without = squared_error(reconstruct(made.samples).color, made.truth);
  const std::vector<float> right = cache_of(made, 0.0);
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (SampledPicture::Half& half : made.samples.halves) {
    half.cache = right;
    for (float& value : half.cache) value = std::max(value * (1.0f + 2.0f * normal(random)), 0.0f);
  }
  EXPECT_LT(squared_error(reconstruct(made.samples).color, made.truth), 1.1 * without);
}

/// Behind a narrow reflection a path's light and what the cache says of it have the same noise.
TEST(Reconstruct, NoiseOfTheCacheBehindTheGuidesIsNotTakenForLight) {
  for (const int spp : {4, 16}) {
    Made made = make_picture(120, 90, spp, 1.0);
    const double without = squared_error(reconstruct(made.samples).color, made.truth);
    for (SampledPicture::Half& half : made.samples.halves) half.cache = half.color;
    const double believed = squared_error(reconstruct(made.samples).color, made.truth);
    made.samples.behind.assign(made.samples.counts.size(), 1.0f);
    const double behind = squared_error(reconstruct(made.samples).color, made.truth);
    EXPECT_GT(believed, 10.0 * without) << spp << " samples";
    EXPECT_LT(behind, 1.6 * without) << spp << " samples";
    RecordProperty("shares_" + std::to_string(spp),
                   std::to_string(believed / without) + " " + std::to_string(behind / without));
  }
}

TEST(Reconstruct, KeepsTheSumOfLight) {
  for (const int spp : {1, 4, 16, 64}) {
    const Made made = make_picture(160, 120, spp, 1.5, 0.2);
    double before = 0.0;
    for (const double value : made.mean) before += value;
    const double after = sum_of(reconstruct(made.samples).color);
    // Weights from one sample itself lose some of the light.
    EXPECT_NEAR(after / before, 1.0, spp == 1 ? 0.03 : 0.005) << spp << " samples";
  }
}

TEST(Reconstruct, ThreadsInstructionSetsAndRegionsGiveTheSameBits) {
  Made made = make_picture(70, 300, 8, 1.0, 0.1);
  for (const bool cached : {false, true}) {
    if (cached) {
      show_cache(made.samples, cache_of(made, 0.1));
      made.samples.halves[1].cache = cache_of(made, 0.2);
      made.samples.behind.assign(made.samples.counts.size(), 0.25f);
    }
    const SampledPicture& samples = made.samples;
    const Reconstruction expected = reconstruct(samples);
    const auto expect_same = [&](const ReconstructionOptions& options, const std::string& what) {
      const Reconstruction result = reconstruct(samples, options);
      EXPECT_TRUE(result.color == expected.color && result.error == expected.error) << what;
    };
    for (const std::size_t threads : {1u, 3u}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      expect_same({}, std::to_string(threads) + " threads");
    }
    for (const neural::simd::Isa isa : neural::simd::available_isas())
      expect_same({.isa = std::string(neural::simd::isa_name(isa))}, std::string(isa_name(isa)));
    for (const int rows : {64, 128, 192}) expect_same({.rows_at_once = rows}, std::to_string(rows) + " rows");
  }
}

Picture picture_with(const std::vector<std::string>& layers) {
  Picture picture{
      .width = 2, .height = 1, .layers = {{.channels = {"R", "G", "B"}, .values = std::vector<float>(6)}}};
  for (const std::string& name : layers) {
    const bool number = name == "samples" || name == "coverage" || name == "guide-depth";
    Layer layer{.name = name, .channels = {"R"}, .values = std::vector<float>(2, 1.0f)};
    if (!number) layer.channels = {"R", "G", "B"}, layer.values.assign(6, 1.0f);
    picture.layers.push_back(layer);
  }
  return picture;
}

TEST(SampledPictures, ReadTheirLayersAndNameTheOneThatIsMissing) {
  const std::vector<std::string> all = {"half-a",   "half-b",       "variance-a",   "variance-b", "samples",
                                        "coverage", "guide-albedo", "guide-normal", "guide-depth"};
  Picture picture = picture_with(all);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  picture.layers[2].values[4] = nan;  // of half-b
  picture.layers.back().values[0] = std::numeric_limits<float>::infinity();
  const SampledPicture samples = take_samples(picture);
  EXPECT_TRUE(samples.halves[0].cache.empty());
  EXPECT_EQ(samples.counts, (std::vector<float>{1.0f, 0.0f}));
  EXPECT_EQ(samples.depth, (std::vector<float>{0.0f, 1.0f}));
  EXPECT_EQ(samples.halves[1].color[4], 0.0f);
  for (const std::string& name : all) {
    std::vector<std::string> others = all;
    std::erase(others, name);
    try {
      Picture incomplete = picture_with(others);
      take_samples(incomplete);
      FAIL() << name;
    } catch (const ImageError& error) {
      EXPECT_NE(std::string(error.what()).find("'" + name + "'"), std::string::npos) << error.what();
    }
  }
  picture.layers.back().channels = {"R", "G"};
  EXPECT_THROW(take_samples(picture), ImageError);
}

}  // namespace
}  // namespace gatelight::renderer
