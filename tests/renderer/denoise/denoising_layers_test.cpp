#include "renderer/denoise/denoising_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/messages.h"
#include "tests/support/noisy_image.h"

namespace gatelight::renderer {
namespace {

using testing::noisy_image;
using testing::rows_of;
using tests::expect_refusal;

Picture picture_with(std::initializer_list<const char*> layers) {
  Picture picture{.width = 2, .height = 1};
  float value = 0.0f;
  for (const char* const name : layers) {
    Layer layer{.name = name, .channels = {"R", "G", "B"}};
    value += 1.0f;
    layer.values.assign(6, value);
    picture.layers.push_back(layer);
  }
  return picture;
}

TEST(DenoisingLayers, ComeBackToTheBitAtAnySize) {
  for (const int factor : {1, 2}) {
    const NoisyImage image = noisy_image(6 * factor, 4 * factor);
    std::vector<float> alpha(image.color.size() / 3);
    for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = 0.01f * static_cast<float>(i);
    Picture picture{.width = 6, .height = 4};
    picture.layers.push_back({.channels = {"R", "G", "B"}, .values = std::vector<float>(3 * 24, 9.0f)});
    const NoisyPicture samples{image.width,
                               image.height,
                               rows_of(image.color, image.width, 3),
                               rows_of(image.albedo, image.width, 3),
                               rows_of(image.normal, image.width, 3),
                               rows_of(alpha, image.width, 1)};
    add_denoising_layers(picture, samples, factor);
    ASSERT_EQ(picture.layers.size(), 1u + 4u * static_cast<unsigned>(factor * factor));
    for (std::size_t i = 1; i < picture.layers.size(); ++i) {
      const Layer& layer = picture.layers[i];
      EXPECT_EQ(layer.values.size(), 24 * layer.channels.size()) << "the size of the picture";
      EXPECT_TRUE(layer.full_precision && is_denoising_layer(layer.name)) << layer.name;
    }
    ASSERT_TRUE(has_denoising_layers(picture));
    const Samples read = samples_of(picture, own_layers(picture));
    EXPECT_EQ(read.factor, factor);
    EXPECT_EQ(read.width, image.width);
    EXPECT_EQ(read.color, image.color);
    EXPECT_EQ(read.albedo, image.albedo);
    EXPECT_EQ(read.normal, image.normal);
    EXPECT_EQ(read.alpha, alpha);
    EXPECT_EQ(read.noisy().color(1, 3), rows_of(image.color, image.width, 3)(1, 3));
  }
}

TEST(DenoisingLayers, NonFiniteValuesAreBlackAndAlphaIsLeftOut) {
  Picture picture = picture_with({""});
  picture.layers[0].channels = {"R", "G", "B", "A"};
  picture.layers[0].values = {1, 2, 3, 0.5f, std::nanf(""), std::numeric_limits<float>::infinity(), 6, 1};
  EXPECT_EQ(samples_of(picture, {}).color, (std::vector<float>{1, 2, 3, 0, 0, 6}));
}

TEST(DenoisingLayers, AreFoundByTheNamesOfTheirChannels) {
  Picture picture{.width = 1, .height = 1};
  picture.layers = {{.channels = {"A", "B", "Z", "G", "R"}, .values = {9, 3, 8, 2, 1}},
                    {.name = "N", .channels = {"Z", "X", "Y"}, .values = {6, 4, 5}},
                    {.name = "grey", .channels = {"A", "Y"}, .values = {9, 7}}};
  const Samples samples = samples_of(picture, {.albedo = "grey", .normal = "N"});
  EXPECT_EQ(samples.color, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(samples.albedo, (std::vector<float>{7, 7, 7}));
  EXPECT_EQ(samples.normal, (std::vector<float>{4, 5, 6}));
}

TEST(DenoisingLayers, APlaneStandsForAGuideThatIsMissing) {
  const Picture picture = picture_with({"", "albedo", "normal"});
  const Samples normals = samples_of(picture, {.normal = "normal"});
  EXPECT_EQ(normals.albedo, std::vector<float>(6, 1.0f));
  EXPECT_EQ(normals.normal, std::vector<float>(6, 3.0f));
  const Samples albedo = samples_of(picture, {.albedo = "albedo"});
  EXPECT_EQ(albedo.normal, (std::vector<float>{0, 0, 1, 0, 0, 1}));
  EXPECT_TRUE(samples_of(picture, {}).normal.empty());
}

TEST(DenoisingLayers, OfWhichOneIsMissingAreRefused) {
  const Picture incomplete = picture_with({"", "denoising-color"});
  expect_refusal<InputError>([&] { samples_of(incomplete, own_layers(incomplete)); }, {"denoising-albedo"});
}

}  // namespace
}  // namespace gatelight::renderer
