// Pictures of textures. Those of 16 bits keep them where they are normal maps, and only there.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/image/png_write.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/png_checksums.h"
#include "tests/support/small_pngs.h"

namespace gatelight::scene {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using tests::expect_message;
using tests::expect_messages;

/// A header that promises 30000 x 30000 pixels, and 12 bytes of data.
const char* const kBomb =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAdTAAAHUwCAIAAADpRW/"
    "tAAAADElEQVR42mNgZGIGAAAOAAfpkjfUAAAAAElFTkSuQmCC";

/// 8x8 grey, all 128.
const std::vector<std::uint8_t> kJpeg = {
    0xff, 0xd8, 0xff, 0xdb, 0, 67, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
    1, 1, 1, 1, 1,
    // One component of 8 bits; a code of one bit each for "no difference" and "end of block".
    0xff, 0xc0, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0, 0xff, 0xc4, 0, 20, 0x00, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0xff, 0xc4, 0, 20, 0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xda,
    0, 8, 1, 1, 0, 0, 63, 0, 0x3f, 0xff, 0xd9};
constexpr std::size_t kJpegScan = 3;  ///< bytes at its end: the block, and the end of the image

/// The pixels of kRgbaUri as lossless WebP; 4x4 pixels of about (60, 120, 180), lossy; and an animation.
const char* const kWebp =
    "data:image/webp;base64,UklGRj4AAABXRUJQVlA4TDEAAAAvAUAAEB8gICFkgv8zjBWSIGDz/1erBAIUxQz/"
    "j1kiECDanElzJpil5LqLG"
    "zBE9D8CAA==";
const char* const kLossyWebp =
    "data:image/webp;base64,UklGRjgAAABXRUJQVlA4ICwAAADwAQCdASoEAAQAAUAmJaACdLoB+AAETAAA/upl//yz5/DZ1Of/"
    "FnIxHZeAAA==";
const char* const kMovingWebp =
    "data:image/"
    "webp;base64,UklGRsoAAABXRUJQVlA4WAoAAAACAAAAAQAAAQAAQU5JTQYAAAAAAAAAAABBTk1GSgAAAAAAAAAAAAEAAAEAAAoAAA"
    "JWUDggMgAAADABAJ0BKgIAAgABQCYloAADcAD+8ut///mwP/bz/wR6Af//0uD//pcH//S4P/"
    "SkAAAAQU5NRkwAAAAAAAAAAAABAAABAAAKAAAAVl"
    "A4IDQAAAA0AQCdASoCAAIAAAAmJaAAA3AA/ukiH//3nz//ufP/+58/6M///yn7//I4//8jj/5QIAAA";
/// The first bytes of KTX2 and DDS files.
const char* const kKtx2 = "data:image/ktx2;base64,q0tUWCAyMLsNChoKAAAAAA==";
const char* const kDds = "data:image/vnd-ms.dds;base64,RERTIHwAAAAHEAAA";

GltfBuilder with_bytes(const std::vector<std::uint8_t>& bytes) {
  GltfBuilder file = with_image({{"mimeType", "image/png"}});
  file.root["images"][0]["bufferView"] = file.view(bytes);
  return file;
}

TEST(Images, KeepEightBitsAndUnassociatedAlpha) {
  const Scene scene = with_image({{"uri", kRgbaUri}}).load();
  ASSERT_EQ(scene.images.size(), 1u);
  const Image& image = scene.images[0];
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, 4);
  EXPECT_THAT(image.pixels, ElementsAre(255, 0, 0, 255, 0, 200, 0, 128, 10, 20, 30, 0, 1, 2, 3, 64));
}

TEST(Images, GreyStaysOneChannel) {
  GltfBuilder file = with_bytes(kGrey);
  file.root["images"][0]["name"] = "ramp";
  const Scene scene = file.load();
  EXPECT_EQ(scene.images.at(0).name, "ramp");
  EXPECT_EQ(scene.images.at(0).channels, 1);
  EXPECT_THAT(scene.images.at(0).pixels, ElementsAre(7, 250));
}

TEST(Images, FilesMayHavePercentEncodedNames) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "my pictures");
  write_bytes(folder.path() / "my pictures" / "grey 50%.png", kGrey);
  const Scene scene = load_gltf(with_image({{"uri", "my%20pictures/grey%2050%25.png"}}).write(folder));
  EXPECT_EQ(scene.images.at(0).width, 2);
}

TEST(Images, TheBytesDecideTheFormatNotTheName) {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "really_a_png.jpg", kGrey);
  EXPECT_EQ(load_gltf(with_image({{"uri", "really_a_png.jpg"}}).write(folder)).images.at(0).pixels.at(1),
            250);
}

TEST(Images, ColourProfilesAreIgnoredInSilence) {
  // A gAMA chunk of 0 and an invalid profile: decoders warn about both on stderr.
  std::vector<std::uint8_t> bytes(kGrey.begin(), kGrey.begin() + 33);
  for (const char* type : {"gAMA", "iCCP"}) {
    for (const int b : {0, 0, 0, 4}) bytes.push_back(static_cast<std::uint8_t>(b));
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(type[i]));
    bytes.insert(bytes.end(), 8, 0);  // the content and a checksum, both wrong
  }
  bytes.insert(bytes.end(), kGrey.begin() + 33, kGrey.end());
  GltfBuilder file = with_bytes(bytes);
  testing::internal::CaptureStderr();
  const Scene scene = file.load();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(scene.images.at(0).pixels, ElementsAre(7, 250));
}

TEST(Images, DamageIsRefusedInSilence) {
  for (std::size_t at = 8; at < kGrey.size(); ++at) {
    SCOPED_TRACE(at);
    std::vector<std::uint8_t> bytes = kGrey;
    bytes[at] ^= 0x55;
    GltfBuilder file = with_bytes(bytes);
    testing::internal::CaptureStderr();
    const std::string message = file.refused();
    // libpng 1.6.48 does not read the checksum of the end, behind all pixels.
    if (!message.empty() || at + 4 < kGrey.size()) expect_message(message, {"images[0]"});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
}

TEST(Images, DamageUnderRightChecksumsIsRefusedInSilence) {
  // Values of the header, the compressed stream and its end.
  for (std::size_t at = 16; at < kGrey.size() - 12; ++at) {
    for (const std::uint8_t value : {0, 3, 6, 255}) {
      std::vector<std::uint8_t> bytes = kGrey;
      if (bytes[at] == value || (at >= 37 && at < 41)) continue;
      bytes[at] = value;
      fuzz::repair_png_checksums(bytes);
      GltfBuilder file = with_bytes(bytes);
      testing::internal::CaptureStderr();
      file.refused();
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << at << " " << int{value};
    }
  }
}

TEST(Images, AHeaderAfterThePixelsIsRefused) {
  std::vector<std::uint8_t> bytes = kGrey;
  bytes.insert(bytes.end() - 12, kGrey.begin() + 8, kGrey.begin() + 33);
  with_bytes(bytes).expect_refused({"images[0]"});
}

TEST(Images, AJpegThatLibjpegWouldCompleteIsRefused) {
  const Scene whole = with_bytes(kJpeg).load();
  EXPECT_THAT(whole.images.at(0).pixels, ::testing::Each(128));
  EXPECT_THAT(whole.warnings, ::testing::IsEmpty());
  std::vector<std::uint8_t> cut = kJpeg;
  cut.erase(cut.end() - kJpegScan, cut.end() - kJpegScan + 1);  // only the block
  with_bytes(cut).expect_refused({"images[0]"});
  EXPECT_THAT(with_bytes(cut).load({.missing_is_error = false}).images.at(0).pixels,
              ElementsAre(255, 255, 255));
  // Extra bytes between segments are harmless.
  std::vector<std::uint8_t> more = kJpeg;
  constexpr std::ptrdiff_t kFrame = 2 + 2 + 67;
  more.insert(more.begin() + kFrame, {1, 2, 3});
  const Scene padded = with_bytes(more).load();
  EXPECT_THAT(padded.images.at(0).pixels, ::testing::Each(128));
  expect_messages(padded.warnings, {{"images[0]"}});
}

TEST(Images, AMissingFileIsAnErrorOrWhite) {
  GltfBuilder file = with_image({{"uri", "absent.png"}});
  file.expect_refused({"images[0]", "absent.png"});
  const Scene scene = file.load({.missing_is_error = false});
  EXPECT_THAT(scene.images.at(0).pixels, ElementsAre(255, 255, 255));
  expect_messages(scene.warnings, {{"absent.png"}});
}

TEST(Images, AMissingFileChangesNoNormalAndDoesNotGlow) {
  const auto missing = [](const json& material) {
    GltfBuilder file = with_image({{"uri", "absent.png"}});
    file.root["materials"][0] = material;
    return file.load({.missing_is_error = false}).images.at(0);
  };
  const json texture = {{"index", 0}};
  EXPECT_THAT(missing({{"normalTexture", texture}}).pixels_16, ElementsAre(32768, 32768, 65535));
  EXPECT_THAT(missing({{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", texture}}).pixels,
              ElementsAre(0, 0, 0));
  const json both = {{"emissiveFactor", {1, 1, 1}},
                     {"emissiveTexture", texture},
                     {"pbrMetallicRoughness", {{"baseColorTexture", texture}}}};
  EXPECT_THAT(missing(both).pixels, ElementsAre(255, 255, 255));
}

TEST(Images, BrokenPicturesAreAnErrorOrWhite) {
  const std::string whole = kRgbaUri;
  std::vector<json> broken = {{{"uri", "data:image/png;base64,QUJDREVGR0hJSktM"}},
                              {{"uri", whole.substr(0, 60)}},
                              {{"uri", "data:image/jpeg;base64,/9j/4AAQ"}},
                              {{"uri", kBomb}},
                              {{"uri", "data:,"}},
                              json::object()};
  for (const json& image : broken) {
    with_image(image).expect_refused({"images[0]"});
    EXPECT_EQ(with_image(image).load({.missing_is_error = false}).images.at(0).width, 1);
  }
}

TEST(Images, WebpIsReadLikePng) {
  const Image png = with_image({{"uri", kRgbaUri}}).load().images.at(0);
  const Image webp = with_image({{"uri", kWebp}}).load().images.at(0);
  EXPECT_EQ(webp.channels, 4);
  EXPECT_EQ(webp.pixels, png.pixels) << "colours under an alpha of 0, too";
  const Image lossy = with_image({{"uri", kLossyWebp}}).load().images.at(0);
  EXPECT_EQ(lossy.channels, 3);
  ASSERT_EQ(lossy.pixels.size(), 4u * 4u * 3u);
  EXPECT_NEAR(lossy.pixels[0], 60, 3);
  EXPECT_NEAR(lossy.pixels[2], 180, 3);
}

TEST(Images, DamagedWebpAndAnimationsAreRefused) {
  const std::string whole = kWebp;
  for (std::size_t length : {whole.size() - 24, whole.size() - 60})
    with_image({{"uri", whole.substr(0, length)}}).expect_refused({"images[0]", "WebP"});
  with_image({{"uri", kMovingWebp}}).expect_refused({"images[0]", "an animation"});
}

/// Returns a texture with a PNG and another picture from an extension.
GltfBuilder with_two(const char* extension, const char* uri) {
  GltfBuilder file = with_image({{"uri", kRgbaUri}});
  file.root["textures"][0]["extensions"][extension]["source"] = file.add("images", {{"uri", uri}});
  file.root["extensionsUsed"] = {extension};
  return file;
}

TEST(Images, ATextureTakesItsWebpAndFallsBackFromUnsupportedFormats) {
  const Scene webp = with_two("EXT_texture_webp", kLossyWebp).load();
  ASSERT_EQ(webp.images.size(), 1u);
  EXPECT_EQ(webp.images[0].width, 4);
  EXPECT_THAT(webp.warnings, testing::IsEmpty());
  for (const auto& [extension, uri] :
       {std::pair("KHR_texture_basisu", kKtx2), std::pair("MSFT_texture_dds", kDds)}) {
    const Scene scene = with_two(extension, uri).load();
    ASSERT_EQ(scene.images.size(), 1u) << extension;
    EXPECT_EQ(scene.images[0].width, 2) << extension;
    EXPECT_THAT(scene.warnings, testing::IsEmpty()) << extension;
  }
}

TEST(Images, WithoutAFallbackTheMessageNamesAConverter) {
  struct Case {
    const char *extension, *uri, *converter;
  };
  for (const Case& c :
       {Case{"KHR_texture_basisu", kKtx2, "ktx extract"}, Case{"MSFT_texture_dds", kDds, "convert"}}) {
    GltfBuilder file = with_two(c.extension, c.uri);
    file.root["extensionsRequired"] = {c.extension};
    file.root["textures"][0].erase("source");
    file.expect_refused({"images[1]", c.converter});
    EXPECT_EQ(file.load({.missing_is_error = false}).images.at(0).width, 1);
  }
}

TEST(Images, WithEqualBytesAreDecodedOnce) {
  GltfBuilder file;
  const int view = file.view(kGrey);
  json primitive = file.triangle();
  for (int i = 0; i < 2; ++i) {
    file.add("images", {{"bufferView", view}});
    file.add("textures", {{"source", i}});
  }
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                         {"emissiveTexture", {{"index", 1}}},
                         {"emissiveFactor", {1, 1, 1}}});
  primitive["material"] = 0;
  file.node({{"mesh", file.mesh(primitive)}});
  const Scene scene = file.load();
  EXPECT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.textures.size(), 2u);
}

TEST(Images, ATextureWithoutASourceIsIgnoredWithAWarning) {
  GltfBuilder file = with_image({{"uri", kRgbaUri}});
  file.root["textures"][0].erase("source");
  const Scene scene = file.load();
  EXPECT_FALSE(scene.materials.at(0).base_color_texture);
  expect_messages(scene.warnings, {{"textures[0]"}});
}

TEST(Images, AMeshWithoutTextureCoordinatesGivesAWarning) {
  GltfBuilder file = with_image({{"uri", kRgbaUri}});
  EXPECT_THAT(file.load().warnings, ::testing::IsEmpty());
  file.root["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  expect_messages(file.load().warnings, {{}});
}

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
