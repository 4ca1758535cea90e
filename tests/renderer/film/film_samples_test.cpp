#include "renderer/film/film_samples.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <vector>

namespace gatelight::renderer {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Maker {
  RenderOptions options;
  Camera camera{scene::Camera{}, 8, 8};
  FilterSampler filter{PixelFilter::box, 1.0f};

  std::vector<CameraSample> samples(const std::vector<Pixel>& pixels, std::uint32_t sample) const {
    const Film film({0, 0, 8, 8}, 8, 8, {});
    std::vector<PixelSample> wanted;
    for (const Pixel& p : pixels) wanted.push_back({p, sample});
    std::vector<CameraSample> result(3);  // its old content is replaced
    make_camera_samples(wanted, film, options, camera, filter, result);
    return result;
  }
};

TEST(CameraSamples, EachPixelHasOneWithinIt) {
  const Maker maker;
  const std::vector<Pixel> pixels = {{0, 0}, {7, 0}, {3, 5}};
  const std::vector<CameraSample> samples = maker.samples(pixels, 0);
  ASSERT_EQ(samples.size(), 3u);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto x = static_cast<float>(pixels[i].x);
    const auto y = static_cast<float>(pixels[i].y);
    const Vec3 d = samples[i].ray().direction;
    const Vec3 low = maker.camera.ray(x, y + 1.0f).ray.direction;
    const Vec3 high = maker.camera.ray(x + 1.0f, y).ray.direction;
    EXPECT_GE(d.x() / d.z(), high.x() / high.z());
    EXPECT_LE(d.x() / d.z(), low.x() / low.z());
    EXPECT_GE(d.y() / d.z(), high.y() / high.z());
    EXPECT_LE(d.y() / d.z(), low.y() / low.z());
    EXPECT_EQ(samples[i].ray().seed, alpha_seed(samples[i].sampler));
  }
}

TEST(CameraSamples, DependOnlyOnPixelSampleAndSeed) {
  Maker maker;
  const CameraSample one = maker.samples({{2, 3}}, 5).front();
  EXPECT_EQ(maker.samples({{1, 1}, {2, 3}}, 5)[1].ray().direction, one.ray().direction);
  std::set<std::uint32_t> seeds = {one.seed, maker.samples({{2, 3}}, 6).front().seed,
                                   maker.samples({{3, 2}}, 5).front().seed,
                                   maker.samples({{2, 5}}, 3).front().seed};
  maker.options.seed += 1;
  const CameraSample other = maker.samples({{2, 3}}, 5).front();
  seeds.insert(other.seed);
  EXPECT_EQ(seeds.size(), 5u);
  EXPECT_NE(other.ray().direction, one.ray().direction);
}

TEST(FirstHit, HoldsThePositionInTheFilesCoordinates) {
  Hit hit;
  hit.t = 4.0f;
  hit.instance = 7;
  hit.primitive = 9;
  Surface surface;
  surface.position = Vec3(1, 2, 3);
  surface.shading_normal = Vec3::UnitY();
  surface.material.base_color = Color(0.1f, 0.2f, 0.3f);
  const FirstHit first = first_hit(hit, surface, Vec3(1000, 0, -1000));
  EXPECT_TRUE(first.hit);
  EXPECT_EQ(first.position, Vec3(1001, 2, -997));
  EXPECT_EQ(first.normal, Vec3(0, 1, 0));
  EXPECT_TRUE((first.albedo == Color(0.1f, 0.2f, 0.3f)).all());
  EXPECT_EQ(first.depth, 4.0f);
  EXPECT_EQ(first.instance, 7u);
  EXPECT_EQ(first.primitive, 9u);
}

TEST(FilmSamples, NonFiniteOnesAreLeftOutAndLocated) {
  Film film({0, 0, 2, 1}, 2, 1, {});
  SampleCounts counts;
  RenderOptions options;
  options.seed = 9;
  const std::vector<SampleResult> good = {{Color(1, 2, 3)}, {Color(4, 5, 6)}};
  const std::vector<SampleResult> bad = {{Color(1, kInfinity, 3)}, {Color(4, 5, 8)}};
  const auto samples = [](std::uint32_t number) {
    return std::vector<PixelSample>{{{0, 0}, number}, {{1, 0}, number}};
  };
  add_to_film(samples(6), options, good, {}, film, counts);
  add_to_film(samples(7), options, bad, {}, film, counts);
  const std::vector<float> mean = film.resolve().layers[0].values;
  EXPECT_EQ(mean, (std::vector<float>{1, 2, 3, 4, 5, 7}));
  EXPECT_EQ(counts.nonfinite, 1u);
  EXPECT_EQ(counts.clamped, 0u);
  ASSERT_EQ(counts.located.size(), 1u);
  EXPECT_EQ(counts.located[0].x, 0);
  EXPECT_EQ(counts.located[0].sample, 7u);
  EXPECT_EQ(counts.located[0].seed, 9u);
}

TEST(FilmSamples, BrightOnesAreScaledToTheClampAndCounted) {
  Film film({0, 0, 2, 1}, 2, 1, {});
  SampleCounts counts;
  const std::vector<PixelSample> samples = {{{0, 0}, 0}, {{1, 0}, 0}};
  RenderOptions options;
  options.clamp = 2.0f;
  const std::vector<SampleResult> results = {{Color(8, 8, 8)}, {Color(1.5f, 1.5f, 1.5f)}};
  add_to_film(samples, options, results, {}, film, counts);
  const std::vector<float> mean = film.resolve().layers[0].values;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(mean[i], i < 3 ? 2.0f : 1.5f, 1e-6f);
  EXPECT_EQ(counts.clamped, 1u);
}

TEST(FilmSamples, PartsAreScaledAndDroppedWithTheirSamples) {
  Film film({0, 0, 2, 1}, 2, 1, {.parts = {"a", "rest"}});
  SampleCounts counts;
  const std::vector<PixelSample> samples = {{{0, 0}, 0}, {{1, 0}, 0}};
  RenderOptions options;
  options.clamp = 2.0f;
  const std::vector<SampleResult> results = {{Color(8, 8, 8)}, {Color(kInfinity, 1, 1)}};
  const std::vector<Color> parts = {Color(2, 2, 2), Color(6, 6, 6), Color(kInfinity, 1, 1), Color(0, 0, 0)};
  add_to_film(samples, options, results, {}, film, counts, parts);
  const std::vector<SampleResult> more = {{Color(1, 1, 0)}, {Color(1, 1, 1)}};
  const std::vector<Color> their = {Color(1, 1, 0), Color(0, 0, 0), Color(0.25f, 1, 0), Color(0.75f, 0, 1)};
  add_to_film(samples, options, more, {}, film, counts, their);
  const Picture picture = film.resolve();
  ASSERT_EQ(picture.layers.size(), 3u);
  const std::vector<float> expected = {0.75f, 0.75f, 0.25f, 0.25f, 1.0f, 0.0f};
  const std::vector<float> expected_rest = {0.75f, 0.75f, 0.75f, 0.75f, 0.0f, 1.0f};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(picture.find("a")->values[i], expected[i], 1e-6f) << i;
    EXPECT_NEAR(picture.find("rest")->values[i], expected_rest[i], 1e-6f) << i;
  }
}

TEST(FilmSamples, FirstHitsOfNonFiniteSamplesCount) {
  Film film({0, 0, 1, 1}, 1, 1, {.aovs = {Aov::depth}});
  SampleCounts counts;
  FirstHit hit;
  hit.hit = true;
  hit.depth = 4.0f;
  const std::vector<SampleResult> results = {{Color(kInfinity, 0, 0)}};
  add_to_film(std::vector<PixelSample>{{}}, {}, results, {&hit, 1}, film, counts);
  EXPECT_FLOAT_EQ(film.resolve().find("depth")->values[0], 4.0f);
}

TEST(FilmSamples, TheFirst16NonFiniteOnesAreKeptInTheOrderOfThePicture) {
  SampleCounts all;
  for (int part = 0; part < 2; ++part) {
    SampleCounts counts{.nonfinite = 10, .clamped = 1};
    for (int i = 0; i < 10; ++i) counts.located.push_back({9 - i, 1 - part, 3u, 0});
    all.add(counts);
  }
  EXPECT_EQ(all.nonfinite, 20u);
  EXPECT_EQ(all.clamped, 2u);
  keep_first(all.located);
  ASSERT_EQ(all.located.size(), 16u);
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(all.located[static_cast<std::size_t>(i)].y, i / 10);
    EXPECT_EQ(all.located[static_cast<std::size_t>(i)].x, i % 10);
  }
}

TEST(FilmSamples, AFilmOfNothingButNonFiniteSamplesKeepsFewPlaces) {
  Film film({0, 0, 16, 16}, 16, 16, {});
  SampleCounts counts;
  const std::vector<PixelSample> samples(256);
  const std::vector<SampleResult> results(256, SampleResult{Color::Constant(kInfinity)});
  for (int s = 0; s < 8; ++s) add_to_film(samples, {}, results, {}, film, counts);
  EXPECT_EQ(counts.nonfinite, 2048u);
  EXPECT_LE(counts.located.size(), 256u);
}

}  // namespace
}  // namespace gatelight::renderer
