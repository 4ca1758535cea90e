#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "renderer/image/half_overflow.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using ::testing::ElementsAre;
using tests::expect_refusal;
using tests::read_file;
using tests::TemporaryFolder;

constexpr float kInf = std::numeric_limits<float>::infinity();

Picture sample_picture() {
  Picture picture{.width = 7, .height = 3};
  Layer beauty{.channels = {"R", "G", "B"}};
  for (int i = 0; i < 7 * 3 * 3; ++i) {
    beauty.values.push_back(std::pow(1.7f, static_cast<float>(i % 23) - 12.0f) +
                            1e-5f * static_cast<float>(i));
  }
  Layer normal{.name = "normal", .channels = {"X", "Y", "Z"}};
  for (int i = 0; i < 7 * 3 * 3; ++i) normal.values.push_back(std::sin(static_cast<float>(i)));
  Layer depth{.name = "depth", .channels = {"Z"}, .full_precision = true};
  for (int i = 0; i < 7 * 3; ++i) depth.values.push_back(i == 5 ? kInf : 1e6f / static_cast<float>(i + 3));
  Layer id{.name = "primitive_id", .channels = {"id"}, .full_precision = true};
  for (int i = 0; i < 7 * 3; ++i) id.values.push_back(static_cast<float>(16777216 - i));
  picture.layers = {beauty, normal, depth, id};
  picture.metadata = {{"seed", "7"}, {"a key that is longer than thirty-one characters", "and its value"}};
  return picture;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(ExrRoundTrip, FloatKeepsEveryBitOfEveryLayer) {
  const TemporaryFolder folder;
  const Picture written = sample_picture();
  write_image(written, folder / "a.exr", {.exr_float = true});
  const Picture read = read_image(folder / "a.exr");
  ASSERT_EQ(read.layers.size(), written.layers.size());
  EXPECT_EQ(read.layers.front().name, "");
  for (const Layer& layer : written.layers) {
    const Layer* found = read.find(layer.name);
    ASSERT_NE(found, nullptr) << layer.name;
    EXPECT_EQ(found->channels, layer.channels) << layer.name;
    EXPECT_TRUE(same_bits(found->values, layer.values)) << layer.name;
  }
  EXPECT_EQ(read.metadata, written.metadata);
}

TEST(ExrRoundTrip, HalfIsNearestHalfAndKeepsFullPrecision) {
  const TemporaryFolder folder;
  const Picture written = sample_picture();
  write_image(written, folder / "a.exr");
  const Picture read = read_image(folder / "a.exr");
  for (const char* name : {"depth", "primitive_id"}) {
    EXPECT_TRUE(same_bits(read.find(name)->values, written.find(name)->values)) << name;
    EXPECT_TRUE(read.find(name)->full_precision);
  }
  for (const char* name : {"", "normal"}) {
    const std::vector<float>& a = written.find(name)->values;
    const std::vector<float>& b = read.find(name)->values;
    ASSERT_EQ(a.size(), b.size());
    EXPECT_FALSE(same_bits(a, b)) << "stored as float";
    EXPECT_FALSE(read.find(name)->full_precision);
    for (std::size_t i = 0; i < a.size(); ++i) {
      // Half a unit in the last of 11 bits; below 2^-14 the spacing is 2^-24.
      EXPECT_NEAR(a[i], b[i], std::max(std::abs(a[i]) / 2048.0f, std::ldexp(1.0f, -25))) << name << i;
    }
  }
}

TEST(ExrRoundTrip, FiniteRadianceBeyondHalfStaysFinite) {
  const TemporaryFolder folder;
  Picture picture{.width = 1, .height = 1};
  picture.layers = {{.channels = {"R", "G", "B"}, .values = {1e6f, -1e6f, kInf}}};
  write_image(picture, folder / "a.exr");
  EXPECT_THAT(read_image(folder / "a.exr").layers[0].values, ElementsAre(65504.0f, -65504.0f, kInf));
}

TEST(HalfOverflow, CountsFiniteValuesOfEachLayerThatHalfWouldChange) {
  Picture picture{.width = 1, .height = 1};
  picture.layers = {{.channels = {"R", "G", "B"}, .values = {1e6f, -65505.0f, kInf}},
                    {.name = "albedo", .channels = {"R", "G", "B"}, .values = {65504.0f, -1.0f, 0.0f}},
                    {.name = "depth", .channels = {"Z"}, .values = {1e6f}, .full_precision = true},
                    {.name = "raw", .channels = {"R", "G", "B"}, .values = {0.0f, 65504.5f, NAN}}};
  const std::vector<HalfOverflow> found = half_overflows(picture);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].layer, "");
  EXPECT_EQ(found[0].values, 2u);
  EXPECT_EQ(found[1].layer, "raw");
  EXPECT_EQ(found[1].values, 1u);
}

TEST(ExrRoundTrip, RegionKeepsItsPlaceInTheFullPicture) {
  const TemporaryFolder folder;
  Picture picture = sample_picture();
  picture.x0 = 40;
  picture.y0 = 9;
  picture.full_width = 64;
  picture.full_height = 32;
  write_image(picture, folder / "a.exr", {.exr_float = true});
  const Picture read = read_image(folder / "a.exr");
  EXPECT_EQ(read.width, 7);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.x0, 40);
  EXPECT_EQ(read.y0, 9);
  EXPECT_EQ(read.full_width, 64);
  EXPECT_EQ(read.full_height, 32);
  EXPECT_TRUE(same_bits(read.layers[0].values, picture.layers[0].values));
  EXPECT_TRUE(same_bits(read.find("depth")->values, picture.find("depth")->values));
}

TEST(ExrRoundTrip, TheBeautyLayerIsTheOneWithColours) {
  const TemporaryFolder folder;
  const auto first = [&](const std::vector<Layer>& layers) {
    Picture picture{.width = 1, .height = 1};
    picture.layers = layers;
    write_image(picture, folder / "a.exr");
    return read_image(folder / "a.exr").layers[0].name;
  };
  const Layer depth{.channels = {"Z"}, .values = {5.0f}};
  const Layer mask{.name = "mask", .channels = {"Y"}, .values = {1.0f}};
  const Layer combined{.name = "view.combined", .channels = {"R", "G", "B"}, .values = {1, 2, 3}};
  const Layer grey{.channels = {"A", "Y"}, .values = {1.0f, 2.0f}};
  EXPECT_EQ(first({depth, mask, combined}), "view.combined");
  EXPECT_EQ(first({combined, grey}), "") << "one without a name comes first";
  EXPECT_EQ(first({mask, depth}), "");
}

int srgb_byte(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double v = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255.0 * v));
}

/// A row of greys from -0.5 to 4, and a NaN.
Picture grey_ramp() {
  Picture picture{.width = 512, .height = 1};
  Layer beauty{.channels = {"R", "G", "B"}};
  for (int x = 0; x < 512; ++x) {
    const float v = x == 511 ? std::nanf("") : -0.5f + 4.5f * static_cast<float>(x) / 510.0f;
    beauty.values.insert(beauty.values.end(), {v, 0.5f * v, 0.001f * v});
  }
  picture.layers = {beauty};
  return picture;
}

TEST(Png, BytesFollowTheFormulasOfSrgbExposureAndNarkowiczsFit) {
  const TemporaryFolder folder;
  const Picture ramp = grey_ramp();
  const auto linear = [](double x) { return x; };
  const auto fit = [](double x) { return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14); };
  struct Shown {
    float stops;
    Tonemap tonemap;
    double (*curve)(double);
  };
  for (const Shown& shown : {Shown{0.0f, Tonemap::none, linear}, Shown{1.0f, Tonemap::none, linear},
                             Shown{-2.5f, Tonemap::none, linear}, Shown{1.0f, Tonemap::filmic, fit}}) {
    write_image(ramp, folder / "a.png", {.display = {.exposure = shown.stops, .tonemap = shown.tonemap}});
    const Picture read = read_image(folder / "a.png");
    ASSERT_EQ(read.width, 512);
    ASSERT_THAT(read.layers[0].channels, ElementsAre("R", "G", "B"));
    for (std::size_t i = 0; i < ramp.layers[0].values.size() - 3; ++i) {
      const double exposed =
          std::max(0.0, static_cast<double>(ramp.layers[0].values[i] * std::exp2(shown.stops)));
      // A rounding of the float pipeline may fall to the other side of one half.
      EXPECT_NEAR(srgb_byte(read.layers[0].values[i]), srgb_byte(shown.curve(exposed)), 1) << i;
    }
    EXPECT_EQ(read.layers[0].values.back(), 0.0f) << "NaN must become black";
  }
}

TEST(Png, ByteStepsAreExactWhereTheFormulaIsFarFromOneHalf) {
  const TemporaryFolder folder;
  Picture picture{.width = 256, .height = 1};
  Layer beauty{.channels = {"R", "G", "B"}};
  for (int b = 0; b < 256; ++b) {
    const double v = b / 255.0;
    const float linear = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    beauty.values.insert(beauty.values.end(), {linear, linear, linear});
  }
  picture.layers = {beauty};
  write_image(picture, folder / "a.png");
  const Picture read = read_image(folder / "a.png");
  for (std::size_t i = 0; i < beauty.values.size(); ++i) {
    EXPECT_EQ(srgb_byte(read.layers[0].values[i]), static_cast<int>(i / 3));
    EXPECT_NEAR(read.layers[0].values[i], beauty.values[i], 1e-6);
  }
}

TEST(Formats, UnknownExtensionNamesFileAndSupportedOnes) {
  expect_refusal<UnknownFormat>([] { write_image(sample_picture(), "x.gif"); },
                                {"x.gif", ".exr", ".png", ".jpg", ".tif", ".hdr"});
  expect_refusal<UnknownFormat>([] { read_image("x.tiff"); }, {"x.tiff", ".exr", ".hdr", ".png"});
  expect_refusal<UnknownFormat>([] { check_image_output("none"); }, {"none"});
}

TEST(Formats, AnOutputWithoutAFolderIsNamedBeforeAnythingIsRendered) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "missing" / "a.exr";
  expect_refusal<OutputError>([&] { check_image_output(file); }, {file.string()});
  check_image_output(folder / "a.exr");
  EXPECT_EQ(folder.count_files(), 0u);
}

TEST(Formats, UnreadableFilesAreNamedInOneLine) {
  const TemporaryFolder folder;
  const std::string missing = (folder / "missing.exr").string();
  expect_refusal<InputError>([&] { read_image(missing); }, {missing});
  write_image(sample_picture(), folder / "whole.exr");
  const std::string whole = read_file(folder / "whole.exr");
  for (const char* extension : {".exr", ".png", ".hdr"}) {
    for (const std::string& content : {std::string(), std::string("not a picture"), whole.substr(0, 40),
                                       whole.substr(0, whole.size() / 2)}) {
      const std::filesystem::path file = folder.write(std::string("broken") + extension, content);
      expect_refusal<InputError>([&] { read_image(file); }, {file.string()});
    }
  }
  std::filesystem::create_directory(folder / "folder.png");
  expect_refusal<InputError>([&] { read_image(folder / "folder.png"); }, {(folder / "folder.png").string()});
}

}  // namespace
}  // namespace gatelight::renderer
