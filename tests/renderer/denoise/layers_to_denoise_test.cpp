#include "renderer/denoise/layers_to_denoise.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

using tests::expect_refusal;

/// Layers of three channels: X, Y, Z where the name says so after a colon.
Picture picture_with(std::initializer_list<const char*> names) {
  Picture picture{.width = 1, .height = 1};
  for (const std::string name : names) {
    const std::size_t colon = name.find(':');
    Layer layer{.name = name.substr(0, colon), .channels = {"R", "G", "B"}};
    if (colon != std::string::npos) {
      layer.channels.clear();
      for (const char channel : name.substr(colon + 1)) layer.channels.emplace_back(1, channel);
    }
    layer.values.assign(layer.channels.size(), 0.0f);
    picture.layers.push_back(layer);
  }
  return picture;
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
