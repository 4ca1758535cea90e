#include "renderer/film/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace gatelight::renderer {
namespace {

TEST(Film, FirstHitsAverageOverHitsAndIdsAreThoseOfTheFirstSample) {
  Film film({0, 0, 1, 1}, 1, 1,
            {.aovs = {Aov::albedo, Aov::depth, Aov::position, Aov::primitive_id, Aov::instance_id}});
  FirstHit hit;
  hit.hit = true;
  hit.albedo = Color(0.8f, 0.4f, 0.2f);
  hit.depth = 4.0f;
  hit.position = Vec3(1, 2, 3);
  hit.instance = 7;
  hit.primitive = 123456;
  film.add(film.take({0, 0}), hit);
  film.add(film.take({0, 0}), FirstHit{});
  const Picture picture = film.resolve();
  EXPECT_FLOAT_EQ(picture.find("albedo")->values[0], 0.4f);
  EXPECT_FLOAT_EQ(picture.find("depth")->values[0], 4.0f);
  EXPECT_FLOAT_EQ(picture.find("position")->values[2], 3.0f);
  EXPECT_FLOAT_EQ(picture.find("instance")->values[0], 7.0f);
  EXPECT_FLOAT_EQ(picture.find("primitive")->values[0], 123456.0f);
}

const std::vector<Aov> kCacheAovs = {Aov::cache_radiance, Aov::cache_answer, Aov::cache_error,
                                     Aov::training_count, Aov::resolution,   Aov::nearest_node};

FirstHit asked_hit(float answer, float error, float count, float resolution) {
  FirstHit hit;
  hit.hit = true;
  hit.queried = true;
  hit.guided = true;
  hit.cache_radiance = Color(7.0f, 8.0f, 9.0f);
  hit.answer = Color(answer, 2.0f * answer, 4.0f * answer);
  hit.node = Color(0.5f, 0.25f, 1.0f);
  hit.error = error;
  hit.training_count = count;
  hit.resolution = resolution;
  return hit;
}

TEST(Film, CacheColoursAreMeansOverSamplesAndCacheNumbersOverQueries) {
  Film film({0, 0, 1, 1}, 1, 1, {.aovs = kCacheAovs});
  EXPECT_TRUE(film.needs_first_hits());
  film.add(film.take({0, 0}), asked_hit(3.0f, 0.5f, 10.0f, 2.0f));
  film.add(film.take({0, 0}), asked_hit(5.0f, 1.5f, 100001.0f, 4.0f));
  FirstHit silent = asked_hit(1e3f, 1e3f, 1e3f, 1e3f);
  silent.queried = false;  // a hit without a query: black, and no number
  film.add(film.take({0, 0}), silent);
  FirstHit sky;
  sky.guided = true;
  film.add(film.take({0, 0}), sky);
  const Picture picture = film.resolve();
  const auto values = [&](const char* name) { return picture.find(name)->values; };
  EXPECT_EQ(values("cache-answer"), (std::vector<float>{2.0f, 4.0f, 8.0f}));
  // The mean is over all paths, with and without a hit.
  EXPECT_EQ(values("cache-radiance"), (std::vector<float>{5.25f, 6.0f, 6.75f}));
  EXPECT_EQ(values("nearest-node"), (std::vector<float>{0.25f, 0.125f, 0.5f}));
  EXPECT_EQ(values("cache-error"), std::vector<float>{1.0f});
  EXPECT_EQ(values("training-count"), std::vector<float>{50005.5f});
  EXPECT_EQ(values("resolution"), std::vector<float>{3.0f});
}

TEST(Film, CacheLayersAreBlackWithoutQueries) {
  Film film({0, 0, 2, 1}, 2, 1, {.aovs = kCacheAovs});
  FirstHit hit;
  hit.hit = true;
  film.add(film.take({0, 0}), hit);
  const Picture picture = film.resolve();
  ASSERT_EQ(picture.layers.size(), 1 + kCacheAovs.size());
  for (const Layer& layer : picture.layers) {
    EXPECT_EQ(layer.values, std::vector<float>(2 * layer.channels.size(), 0.0f)) << layer.name;
  }
}

TEST(Film, CacheLayersHaveTheirPlacesChannelsAndPrecision) {
  Film film({0, 0, 2, 1}, 2, 1, {.aovs = kCacheAovs});
  film.add(film.take({1, 0}), asked_hit(1.0f, 2.0f, 3.0f, 4.0f));
  const Picture picture = film.resolve();
  const std::vector<std::string> rgb{"R", "G", "B"};
  struct Expected {
    const char* name;
    std::vector<std::string> channels;
    bool full_precision;
    float value;  ///< of the second pixel's first channel
  };
  // Counts go beyond the range of a half float.
  const Expected all[] = {{"cache-radiance", rgb, true, 7.0f},    {"cache-answer", rgb, false, 1.0f},
                          {"cache-error", {"error"}, true, 2.0f}, {"training-count", {"count"}, true, 3.0f},
                          {"resolution", {"R"}, true, 4.0f},      {"nearest-node", rgb, false, 0.5f}};
  for (std::size_t i = 0; i < std::size(all); ++i) {
    SCOPED_TRACE(all[i].name);
    const Layer& layer = picture.layers[1 + i];  // in the requested order, after the beauty
    EXPECT_EQ(layer.name, all[i].name);
    EXPECT_EQ(layer.channels, all[i].channels);
    EXPECT_EQ(layer.full_precision, all[i].full_precision);
    EXPECT_EQ(layer.values[0], 0.0f);
    EXPECT_EQ(layer.values[layer.channels.size()], all[i].value);
  }
  // They come from the first hit, which costs memory; sample counts do not.
  EXPECT_FALSE(Film({0, 0, 1, 1}, 1, 1, {.aovs = {Aov::sample_count}}).needs_first_hits());
  EXPECT_GT(Film::bytes_per_pixel({.aovs = kCacheAovs}),
            Film::bytes_per_pixel({.aovs = {Aov::sample_count}}));
}

TEST(Film, HalvesAreTheMeansOfEveryOtherSample) {
  Film film({0, 0, 2, 1}, 2, 1, {.half = true});
  for (const float value : {1.0f, 5.0f, 3.0f}) film.add(film.take({0, 0}), Color::Constant(value));
  film.add(film.take({1, 0}), Color::Constant(4.0f));
  EXPECT_EQ(film.plane(Plane::mean, 0, 1), (std::vector<float>{3, 3, 3, 4, 4, 4}));
  EXPECT_EQ(film.plane(Plane::half_a, 0, 1), (std::vector<float>{2, 2, 2, 4, 4, 4}));
  // A pixel with one sample has no second half, and takes the mean.
  EXPECT_EQ(film.plane(Plane::half_b, 0, 1), (std::vector<float>{5, 5, 5, 4, 4, 4}));
  EXPECT_EQ(film.resolve().layers.size(), 1u) << "planes are no layers";
}

TEST(Film, GuidesAndAlphaAreMeansOverAllSamples) {
  Film film({0, 1, 1, 3}, 1, 4, {.guides = true, .alpha = true});
  EXPECT_TRUE(film.needs_first_hits());
  FirstHit hit;
  hit.guide = {true, 0, Color::Ones(), Color(0.8f, 0.4f, 0.2f), Vec3(0, 0, 1)};
  FirstHit sky;
  sky.alpha = 0.0f;
  for (const FirstHit& first : {hit, sky}) {
    film.add(film.take({0, 2}), first);  // whether or not its light counts
  }
  EXPECT_EQ(film.plane(Plane::albedo, 2, 3), (std::vector<float>{0.4f, 0.2f, 0.1f}));
  EXPECT_EQ(film.plane(Plane::normal, 1, 3), (std::vector<float>{0, 0, 0, 0, 0, 0.5f}));
  EXPECT_EQ(film.plane(Plane::alpha, 1, 3), (std::vector<float>{0, 0.5f}));
}

TEST(Film, ValuesBeyondSinglePrecisionBecomeItsGreatestNumber) {
  Film film({0, 0, 1, 1}, 1, 1, {.aovs = {Aov::variance}});
  film.add(film.take({0, 0}), Color(1e30f, 1.0f, 0.0f));
  film.add(film.take({0, 0}), Color(0.0f, 3.0f, 0.0f));
  const Picture picture = film.resolve();
  EXPECT_THAT(picture.find("variance")->values,
              ::testing::ElementsAre(std::numeric_limits<float>::max(), 1.0f, 0.0f));
  EXPECT_FLOAT_EQ(picture.layers[0].values[0], 5e29f);
}

}  // namespace
}  // namespace gatelight::renderer
