#include "renderer/film/film_samples.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace gatelight::renderer {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

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
