// Layers of a picture for a denoiser: its own, and those of other renderers.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/errors.h"
#include "renderer/denoise/denoising_layers.h"
#include "renderer/denoise/layers_to_denoise.h"
#include "tests/support/messages.h"
#include "tests/support/noisy_image.h"

namespace gatelight::renderer {
namespace {

using testing::noisy_image;
using testing::rows_of;
using tests::expect_refusal;

/// Layers of three channels, those after a colon where there is one. All values of the n-th are n.
Picture picture_with(std::initializer_list<const char*> names) {
  Picture picture{.width = 2, .height = 1};
  for (const std::string name : names) {
    const std::size_t colon = name.find(':');
    Layer layer{.name = name.substr(0, colon), .channels = {"R", "G", "B"}};
    if (colon != std::string::npos) {
      layer.channels.clear();
      for (const char channel : name.substr(colon + 1)) layer.channels.emplace_back(1, channel);
    }
    layer.values.assign(2 * layer.channels.size(), static_cast<float>(picture.layers.size() + 1));
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
                               rows_of(alpha, image.width, 1),
                               PixelRect{1, 2, 3, 4}};
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
    EXPECT_EQ(read.noisy().noisy_guides, (PixelRect{1, 2, 3, 4}));
    for (const char* text : {"1,2,3,4/9x9", "1,2,3,400", "", "-1,0,2,2/6x4", "3,2,1,4/6x4"}) {
      picture.metadata["noisy-guides"] = text;
      EXPECT_FALSE(samples_of(picture, own_layers(picture)).noisy_guides) << text;
    }
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

std::string text_of(const std::vector<LayersToDenoise>& all) {
  std::string text;
  for (const LayersToDenoise& some : all) {
    text += (text.empty() ? "" : "; ") + some.color + " > " + some.result;
    text += " | " + some.albedo.value_or("-") + " | " + some.normal.value_or("-");
  }
  return text;
}

std::string chosen(std::initializer_list<const char*> names, const LayerNames& flags = {}) {
  return text_of(layers_to_denoise(picture_with(names), flags));
}

TEST(LayersToDenoise, AreFoundByTheNamesOfRenderersInAnyCase) {
  EXPECT_EQ(chosen({"V.Combined", "V.Denoising Albedo", "V.Denoising Normal:XYZ"}),
            "V.Combined > V.Combined | V.Denoising Albedo | V.Denoising Normal");
  EXPECT_EQ(chosen({"", "Albedo", "N:XYZ"}), " >  | Albedo | N");
  EXPECT_EQ(chosen({"", "ALBEDO", "Normal"}), " >  | ALBEDO | Normal") << "normals as R, G and B";
  EXPECT_EQ(chosen({"", "denoise_albedo", "sh_normal:XYZ"}), " >  | denoise_albedo | sh_normal");
  EXPECT_EQ(chosen({"", "raw"}), "raw >  | - | -") << "the samples of a picture that is denoised already";
  EXPECT_EQ(chosen({"V.Combined", "V.Normal:XYZ", "V.Denoising Normal:XYZ"}),
            "V.Combined > V.Combined | - | V.Denoising Normal");
}

TEST(LayersToDenoise, AreThoseOfEachViewLayerWithAGuide) {
  EXPECT_EQ(chosen({"V.Combined", "V.Noisy Image", "V.Denoising Albedo", "O.Combined", "O.Normal:XYZ"}),
            "V.Noisy Image > V.Combined | V.Denoising Albedo | -; O.Combined > O.Combined | - | O.Normal");
  EXPECT_EQ(chosen({"V.Combined", "O.Combined", "O.Albedo"}), "O.Combined > O.Combined | O.Albedo | -");
  EXPECT_EQ(chosen({"V.Combined", "O.Combined"}), "V.Combined > V.Combined | - | -") << "what is shown";
  EXPECT_EQ(chosen({"V.Combined.left", "V.Combined.right", "V.Albedo.right"}),
            "V.Combined.right > V.Combined.right | V.Albedo.right | -");
  EXPECT_EQ(chosen({"", "V.Albedo"}), " >  | V.Albedo | -") << "a guide of any name, where none has its own";
  const Picture two = picture_with({"V.Combined", "O.Combined", "O.Albedo"});
  EXPECT_EQ(colors_left(two, layers_to_denoise(two)), std::vector<std::string>{"V.Combined"});
}

TEST(LayersToDenoise, CanBeNamed) {
  const std::initializer_list<const char*> names = {"", "image", "V.image", "V.n:XYZ", "albedo", "N:XYZ"};
  EXPECT_EQ(chosen(names, {.color = "image"}), "image > image | albedo | N");
  EXPECT_EQ(chosen(names, {.color = "IMAGE"}), "image > image | albedo | N") << "in any case";
  EXPECT_EQ(chosen(names, {.color = "V.image"}), "V.image > V.image | - | V.n") << "guides of its view layer";
  EXPECT_EQ(chosen(names, {.albedo = "image", .normal = "V.n"}), " >  | image | V.n");
  EXPECT_EQ(chosen(names, {.albedo = "none"}), " >  | - | N");
  EXPECT_EQ(chosen(names, {.albedo = "none", .normal = "none"}), " >  | - | -");
  EXPECT_EQ(chosen({"V.Combined", "V.n:XYZ", "V.m:XYZ", "O.Combined", "O.n:XYZ"}, {.normal = "V.m"}),
            "V.Combined > V.Combined | - | V.m; O.Combined > O.Combined | - | O.n");
}

TEST(LayersToDenoise, WithOtherChannelsAreNoGuides) {
  EXPECT_EQ(chosen({"", "albedo:XY", "N:Z"}), " >  | - | -");
  EXPECT_EQ(chosen({":Y", "albedo:Y"}), " >  | albedo | -") << "grey";
  const Picture picture = picture_with({"", "N:Z", "depth:Z"});
  expect_refusal<InputError>([&] { layers_to_denoise(picture, {.normal = "N"}); },
                             {"'N'", "Z", "X, Y and Z"});
  expect_refusal<InputError>([&] { layers_to_denoise(picture, {.color = "depth"}); },
                             {"'depth'", "R, G and B"});
  expect_refusal<InputError>([&] { layers_to_denoise(picture, {.albedo = "a"}); }, {"no layer 'a'"});
  const Picture depth = picture_with({"depth:Z"});
  expect_refusal<InputError>([&] { layers_to_denoise(depth); }, {"'depth'", "R, G and B"});
}

}  // namespace
}  // namespace gatelight::renderer
