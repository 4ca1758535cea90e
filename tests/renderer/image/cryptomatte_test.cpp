#include "renderer/image/cryptomatte.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

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

}  // namespace
}  // namespace gatelight::renderer
