#include "renderer/film.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {
namespace {

TEST(Film, PixelIsTheMeanAndVarianceIsThatOfTheMean) {
  const Aov aovs[] = {Aov::variance, Aov::sample_count};
  Film film({2, 1, 4, 3}, 8, 8, aovs);
  for (float v : {1.0f, 2.0f, 6.0f}) film.add(3, 2, Color(v, 2.0f * v, 0.0f));
  const Picture picture = film.resolve();
  EXPECT_EQ(picture.x0, 2);
  EXPECT_EQ(picture.full_width, 8);
  const std::size_t i = 3 * 3;  // the last of four pixels
  EXPECT_FLOAT_EQ(picture.layers[0].values[i], 3.0f);
  EXPECT_FLOAT_EQ(picture.layers[0].values[i + 1], 6.0f);
  // Sample variance 7, over three samples.
  EXPECT_FLOAT_EQ(picture.find("variance")->values[i], 7.0f / 3.0f);
  EXPECT_FLOAT_EQ(picture.find("variance")->values[i + 1], 28.0f / 3.0f);
  EXPECT_FLOAT_EQ(picture.find("samples")->values[3], 3.0f);
  EXPECT_FLOAT_EQ(picture.layers[0].values[0], 0.0f);
}

TEST(Film, FirstHitsAverageOverHitsAndIdsAreThoseOfTheFirstSample) {
  const Aov aovs[] = {Aov::albedo, Aov::depth, Aov::position, Aov::primitive_id, Aov::instance_id};
  Film film({0, 0, 1, 1}, 1, 1, aovs);
  FirstHit hit;
  hit.hit = true;
  hit.albedo = Color(0.8f, 0.4f, 0.2f);
  hit.depth = 4.0f;
  hit.position = Vec3(1, 2, 3);
  hit.instance = 7;
  hit.primitive = 123456;
  film.add(0, 0, hit);
  film.add(0, 0, FirstHit{});
  const Picture picture = film.resolve();
  EXPECT_FLOAT_EQ(picture.find("albedo")->values[0], 0.4f);
  EXPECT_FLOAT_EQ(picture.find("depth")->values[0], 4.0f);
  EXPECT_FLOAT_EQ(picture.find("position")->values[2], 3.0f);
  EXPECT_FLOAT_EQ(picture.find("instance")->values[0], 7.0f);
  EXPECT_FLOAT_EQ(picture.find("primitive")->values[0], 123456.0f);
}

TEST(Film, AMillionSamplesDoNotDrift) {
  Film film({0, 0, 1, 1}, 1, 1, {});
  for (int i = 0; i < 1000000; ++i) film.add(0, 0, Color(0.1f, 1e-6f, 1e6f));
  const Picture picture = film.resolve();
  EXPECT_FLOAT_EQ(picture.layers[0].values[0], 0.1f);
  EXPECT_FLOAT_EQ(picture.layers[0].values[1], 1e-6f);
  EXPECT_FLOAT_EQ(picture.layers[0].values[2], 1e6f);
}

}  // namespace
}  // namespace gatelight::renderer
