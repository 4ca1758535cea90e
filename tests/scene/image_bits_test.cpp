// Pictures of 16 bits keep them where they are normal maps, and only there.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/image/png_write.h"
#include "tests/support/gltf_builder.h"

namespace gatelight::scene {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<std::uint16_t> kPixel = {32800, 32768, 65535};
const json kTexture = {{"index", 0}};
const json kAsNormal = {{"normalTexture", kTexture}};
const json kAsColor = {{"pbrMetallicRoughness", {{"baseColorTexture", kTexture}}}};
const json kAsRoughness = {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", kTexture}}}};
const json kAsCoatNormal = {
    {"extensions",
     {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1.0}, {"clearcoatNormalTexture", kTexture}}}}}};

/// Loads the picture, which a triangle of each material reads.
Image loaded(const std::vector<std::uint8_t>& png, const std::vector<json>& materials) {
  GltfBuilder file;
  file.add("images", {{"mimeType", "image/png"}});
  file.root["images"][0]["bufferView"] = file.view(png);
  file.add("textures", {{"source", 0}});
  for (const json& material : materials) {
    json primitive = file.triangle();
    primitive["material"] = file.add("materials", material);
    file.node({{"mesh", file.mesh(primitive)}});
  }
  return file.load().images.at(0);
}

std::vector<std::uint8_t> png_16() {
  return encode_png(std::span<const std::uint16_t>(kPixel), 1, 1, 3);
}

TEST(ImageBits, NormalMapsKeepSixteen) {
  for (const auto& materials : {std::vector{kAsNormal}, {kAsCoatNormal}, {kAsNormal, kAsCoatNormal}}) {
    const Image image = loaded(png_16(), materials);
    EXPECT_EQ(image.pixels_16, kPixel);
    EXPECT_THAT(image.pixels, IsEmpty());
    EXPECT_EQ(image.channels, 3);
  }
}

TEST(ImageBits, OtherUsesGetEight) {
  for (const auto& materials :
       {std::vector{kAsColor}, {kAsRoughness}, {kAsNormal, kAsColor}, {kAsRoughness, kAsCoatNormal}}) {
    const Image image = loaded(png_16(), materials);
    EXPECT_THAT(image.pixels_16, IsEmpty());
    EXPECT_THAT(image.pixels, ElementsAre(128, 128, 255));
  }
}

TEST(ImageBits, NormalMapsOfEightStayEight) {
  const std::vector<std::uint8_t> pixel = {127, 128, 255};
  const Image image = loaded(encode_png(std::span<const std::uint8_t>(pixel), 1, 1, 3), {kAsNormal});
  EXPECT_THAT(image.pixels_16, IsEmpty());
  EXPECT_EQ(image.pixels, pixel);
}

TEST(ImageBits, SixteenTakeTwiceTheMemory) {
  Scene scene;
  scene.images = {loaded(png_16(), {kAsNormal}), loaded(png_16(), {kAsColor})};
  EXPECT_EQ(image_bytes(scene), 6u + 3u);
}

}  // namespace
}  // namespace gatelight::scene
