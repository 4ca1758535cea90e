// Layers of EXR files: Cryptomatte, and files of several parts, as Blender and others write them.

#include "renderer/image/cryptomatte.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/denoise/layers_to_denoise.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/image/murmur_hash.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using tests::TemporaryFolder;

TEST(MurmurHash, HasThePublishedValues) {
  EXPECT_EQ(murmur_hash(""), 0u);
  EXPECT_EQ(murmur_hash("hello"), 0x248bfa47u);
  EXPECT_EQ(murmur_hash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmur_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(CryptomatteId, IsThatOfTheSpecification) {
  EXPECT_EQ(cryptomatte_id("bunny"), 0x13851a76u);
  EXPECT_EQ(cryptomatte_id("default"), 0x42c9679fu);
  EXPECT_EQ(cryptomatte_id("bunny_porcelain_mat"), 0xb24b26d4u);
}

TEST(CryptomatteId, IsAlwaysANormalNumber) {
  int flipped = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string name = "object " + std::to_string(i);
    const std::uint32_t hash = murmur_hash(name), id = cryptomatte_id(name);
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(id))) << name;
    flipped += hash != id ? 1 : 0;
    if (hash != id) {
      EXPECT_EQ(hash ^ id, 1u << 23) << name;
    }
  }
  // Two of 256 exponents.
  EXPECT_NEAR(flipped, 20000 / 128, 60);
  EXPECT_TRUE(std::isnormal(std::bit_cast<float>(cryptomatte_id(""))));
}

const std::vector<std::string> kNames = {"bunny", "default", "bunny", "a \"quoted\\ name\"\n"};

TEST(CryptomatteHeader, NamesTheKindAndAllNames) {
  Cryptomattes mattes;
  EXPECT_EQ(add_kind(mattes, "CryptoObject", kNames, 2), 0u);
  EXPECT_EQ(add_kind(mattes, "CryptoMaterial", {}, 2), 3u);
  ASSERT_EQ(mattes.layers.size(), 6u);
  EXPECT_EQ(mattes.layers[2].name, "CryptoObject02");
  EXPECT_EQ(mattes.layers[3].name, "CryptoMaterial00");
  EXPECT_EQ(mattes.attributes.size(), 8u);
  int found = 0;
  for (const auto& [key, value] : mattes.attributes) {
    EXPECT_LE(key.size(), 31u);
    if (!key.ends_with("/name") || value != "CryptoObject") continue;
    ++found;
    const std::string prefix = key.substr(0, key.size() - 4);
    EXPECT_EQ(prefix.size(), std::string("cryptomatte/1234567/").size());
    EXPECT_EQ(mattes.attributes.at(prefix + "hash"), "MurmurHash3_32");
    EXPECT_EQ(mattes.attributes.at(prefix + "conversion"), "uint32_to_float32");
    const std::string manifest = mattes.attributes.at(prefix + "manifest");
    EXPECT_TRUE(manifest.starts_with(R"({"a \"quoted\\ name\"\u000a":")")) << manifest;
    EXPECT_TRUE(manifest.ends_with(R"(","bunny":"13851a76","default":"42c9679f"})")) << manifest;
  }
  EXPECT_EQ(found, 1);
}

Picture with_mattes() {
  Picture picture{.width = 2, .height = 1, .full_width = 2, .full_height = 1};
  picture.layers = {{.channels = {"R", "G", "B"}, .values = std::vector<float>(6, 0.5f)}};
  Cryptomattes mattes;
  const std::size_t first = add_kind(mattes, "CryptoObject", kNames, 2);
  std::vector<IdCoverage> ids;
  for (std::uint32_t i = 0; i < 8; ++i)
    ids.push_back({cryptomatte_id(std::to_string(i)), 0.5f / static_cast<float>(i + 1)});
  set_pixel(mattes, first, 1, ids);
  add_cryptomattes(picture, std::move(mattes));
  return picture;
}

TEST(Cryptomatte, RanksFillTheLayersInPairs) {
  const Picture picture = with_mattes();
  for (std::size_t rank = 0; rank < kCryptomatteRanks; ++rank) {
    const std::string name = "CryptoObject0" + std::to_string(rank / 2);
    const Layer* layer = picture.find(name);
    ASSERT_NE(layer, nullptr) << name;
    const float* value = &layer->values[4 + 2 * (rank % 2)];
    EXPECT_EQ(std::bit_cast<std::uint32_t>(value[0]), cryptomatte_id(std::to_string(rank)));
    EXPECT_EQ(value[1], 0.5f / static_cast<float>(rank + 1));
    EXPECT_EQ(layer->values[2 * (rank % 2)], 0.0f) << "the other pixel has none";
  }
}

TEST(Cryptomatte, AFileKeepsBitsAndHeaderWhateverItsPrecision) {
  const TemporaryFolder folder;
  const Picture written = with_mattes();
  write_image(written, folder / "a.exr", {.exr_float = false});
  const Picture read = read_image(folder / "a.exr");
  EXPECT_EQ(read.attributes, written.attributes);
  EXPECT_TRUE(read.metadata.empty());
  EXPECT_EQ(read.layers.front().name, "");
  for (const char* name : {"CryptoObject00", "CryptoObject01", "CryptoObject02"}) {
    ASSERT_NE(read.find(name), nullptr) << name;
    EXPECT_EQ(read.find(name)->channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(read.find(name)->values, written.find(name)->values);
    EXPECT_TRUE(is_cryptomatte(read, name));
  }
  EXPECT_FALSE(is_cryptomatte(read, ""));
  EXPECT_FALSE(is_cryptomatte(read, "CryptoMaterial00"));

  const Imf::InputFile file((folder / "a.exr").c_str());
  for (const auto& [key, value] : written.attributes) {
    const auto* text = file.header().findTypedAttribute<Imf::StringAttribute>(key);
    ASSERT_NE(text, nullptr) << key;
    EXPECT_EQ(text->value(), value);
  }
  const Imf::Channel* id = file.header().channels().findChannel("CryptoObject00.R");
  ASSERT_NE(id, nullptr);
  EXPECT_EQ(id->type, Imf::FLOAT);
}

struct Part {
  std::string name;
  std::vector<std::string> channels;
  float value = 0.0f;  ///< of the first channel; each other has one more
  int width = 3;
};

/// Writes parts with a height of 2.
std::string write_parts(const TemporaryFolder& folder, const std::vector<Part>& parts) {
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    Imf::Header header(3, 2);
    header.dataWindow().max.x = part.width - 1;
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const std::string& channel : part.channels)
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    headers.push_back(header);
  }
  const std::string path = (folder / "parts.exr").string();
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Imf::FrameBuffer frame;
    std::vector<std::vector<float>> values;
    const auto width = static_cast<std::size_t>(parts[p].width);
    for (std::size_t c = 0; c < parts[p].channels.size(); ++c)
      values.emplace_back(2 * width, parts[p].value + static_cast<float>(c));
    for (std::size_t c = 0; c < values.size(); ++c) {
      frame.insert(parts[p].channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values[c].data()),
                                                    sizeof(float), width * sizeof(float)));
    }
    Imf::OutputPart part(file, static_cast<int>(p));
    part.setFrameBuffer(frame);
    part.writePixels(2);
  }
  return path;
}

TEST(ExrParts, AreLayersWithTheNamesOfTheirChannelsOrTheirOwn) {
  const TemporaryFolder folder;
  const Picture picture = read_image(write_parts(
      folder,
      {{"View.Depth", {"View.Depth.Z"}, 1.0f},
       {"View.Combined", {"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Combined.A"}, 2.0f},
       {"View.Denoising Albedo",
        {"View.Denoising Albedo.R", "View.Denoising Albedo.G", "View.Denoising Albedo.B"},
        10.0f},
       {"View.Denoising Normal", {"X", "Y", "Z"}, 20.0f}}));
  ASSERT_EQ(picture.layers.size(), 4u);
  EXPECT_EQ(picture.layers[0].name, "View.Combined") << "the layer that is shown comes first";
  EXPECT_EQ(picture.layers[0].values[2], 4.0f);
  ASSERT_TRUE(picture.find("View.Denoising Normal")) << "channels without a layer take the name of the part";
  EXPECT_EQ(picture.find("View.Depth")->values, std::vector<float>(6, 1.0f));
  // The guides of other renderers are found in parts too.
  const Samples samples = samples_of(picture, layers_to_denoise(picture).front());
  ASSERT_EQ(samples.albedo.size(), 18u);
  EXPECT_EQ(samples.color[0], 2.0f);
  EXPECT_EQ(samples.albedo[4], 11.0f);
  EXPECT_EQ(samples.normal[17], 22.0f);
}

TEST(ExrParts, OfAnotherSizeAndOfTheSameNameAreLeftOut) {
  const TemporaryFolder folder;
  const Picture picture = read_image(write_parts(folder, {{"left", {"R", "G", "B"}, 1.0f},
                                                          {"right", {"right.R", "right.G", "right.B"}, 5.0f},
                                                          {"again", {"right.R"}, 7.0f},
                                                          {"thumbnail", {"R", "G", "B"}, 9.0f, 2}}));
  ASSERT_EQ(picture.layers.size(), 2u);
  EXPECT_EQ(picture.layers[0].name, "left");
  EXPECT_EQ(picture.find("right")->values[0], 5.0f);
}

TEST(ExrParts, PutTheBeautyPartFirst) {
  const TemporaryFolder folder;
  const Picture picture = read_image(write_parts(
      folder,
      {{"albedo", {"R", "G", "B"}, 1.0f}, {"Beauty", {"R", "G", "B"}, 5.0f}, {"N", {"X", "Y", "Z"}, 9.0f}}));
  EXPECT_EQ(picture.layers[0].name, "Beauty");
  const Samples samples = samples_of(picture, layers_to_denoise(picture).front());
  EXPECT_EQ(samples.color[0], 5.0f);
  EXPECT_EQ(samples.albedo[0], 1.0f);
  EXPECT_EQ(samples.normal[0], 9.0f);
}

/// A crash left the second part behind without pixels.
TEST(ExrParts, ThatCannotBeReadAreLeftOut) {
  const TemporaryFolder folder;
  const std::string path =
      write_parts(folder, {{"rgba", {"R", "G", "B"}, 1.0f}, {"N", {"X", "Y", "Z"}, 9.0f}});
  ASSERT_EQ(read_image(path).layers.size(), 2u);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 8);
  const Picture picture = read_image(path);
  ASSERT_EQ(picture.layers.size(), 1u);
  EXPECT_EQ(picture.layers[0].values[1], 2.0f);
}

}  // namespace
}  // namespace gatelight::renderer
