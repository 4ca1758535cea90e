#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/gltf_builder.h"

namespace gatelight::scene {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

GltfBuilder triangle_file() {
  GltfBuilder file;
  file.node({{"mesh", file.mesh(file.triangle())}});
  return file;
}

std::string refused_bytes(const std::vector<std::uint8_t>& bytes, const char* name = "test.glb") {
  const TemporaryFolder folder;
  write_bytes(folder.path() / name, bytes);
  return refusal(folder.path() / name);
}

std::vector<std::uint8_t> text_bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[v >> (18 - 6 * k) & 63];
  }
  return out;
}

TEST(Container, JsonWithADataUriEqualsTheBinary) {
  GltfBuilder file = triangle_file();
  const Mesh binary = only_mesh(file.load());
  const TemporaryFolder folder;
  json root = file.root;
  root["buffers"] = {
      {{"byteLength", file.bin.size()}, {"uri", "data:application/octet-stream;base64," + base64(file.bin)}}};
  write_bytes(folder.path() / "a.gltf", text_bytes(root.dump(2)));
  root["buffers"][0]["uri"] = "data%20file.bin";
  write_bytes(folder.path() / "b.gltf", text_bytes(root.dump()));
  write_bytes(folder.path() / "data file.bin", file.bin);
  root["buffers"][0]["uri"] = "DATA:;Base64," + base64(file.bin);
  write_bytes(folder.path() / "c.gltf", text_bytes(root.dump()));
  for (const char* name : {"a.gltf", "b.gltf", "c.gltf"}) {
    EXPECT_EQ(only_mesh(load_gltf(folder.path() / name)).positions, binary.positions) << name;
  }
}

TEST(Container, MessagesNameTheFileFirst) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "nowhere.glb").string();
  EXPECT_THAT(refusal(path), AllOf(StartsWith(path + ": "), HasSubstr("does not exist")));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("not a regular file"));
}

TEST(Container, BrokenHeadersAreRefused) {
  const std::vector<std::uint8_t> whole = triangle_file().glb();
  const auto with = [&](std::size_t offset, std::uint8_t value) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[offset] = value;
    return refused_bytes(bytes);
  };
  EXPECT_EQ(refused_bytes(whole), "");
  EXPECT_THAT(refused_bytes({}), HasSubstr("empty file"));
  EXPECT_THAT(refused_bytes({'g', 'l', 'T', 'F', 2}), HasSubstr("header of 12"));
  EXPECT_THAT(with(0, 'x'), HasSubstr("'glTF'"));
  EXPECT_THAT(with(4, 1), HasSubstr("version 1, expected 2"));
  EXPECT_THAT(with(11, 0x7f), HasSubstr("length"));
  EXPECT_THAT(with(15, 0x7f), HasSubstr("chunk 0"));
  EXPECT_THAT(with(16, 0), HasSubstr("expected JSON first"));
  std::vector<std::uint8_t> cut(whole.begin(), whole.end() - 8);
  EXPECT_THAT(refused_bytes(cut), HasSubstr("the size of the file"));
}

TEST(Container, BytesAfterTheEndAreIgnoredWithAWarning) {
  std::vector<std::uint8_t> bytes = triangle_file().glb();
  bytes.resize(bytes.size() + 5);
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.glb", bytes);
  EXPECT_THAT(load_gltf(folder.path() / "test.glb").warnings,
              ElementsAre(HasSubstr("5 bytes after the end")));
}

TEST(Container, WhatIsNoGltfIsRefusedInOneLine) {
  for (const char* text :
       {"{", "[]", "null", "{}", "{\"asset\":{}}", "\xff\xfe{}", "{\"asset\":{\"version\":\"2.0\"},}",
        "{\n\"asset\":\n1e999}", "{\"asset\":{\"version\":\"2.0\\n3\"}}"}) {
    const std::string message = refused_bytes(text_bytes(text), "test.gltf");
    EXPECT_THAT(message, HasSubstr("test.gltf: ")) << text;
    EXPECT_EQ(message.find('\n'), std::string::npos) << text;
  }
}

TEST(Container, DeepNestingIsRefusedNotFollowed) {
  const std::string deep = "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(1000000, '[');
  EXPECT_THAT(refused_bytes(text_bytes(deep), "test.gltf"), HasSubstr("nested deeper"));
}

TEST(Container, NumbersMayBeWrittenWithAFraction) {
  GltfBuilder file = triangle_file();
  file.root["nodes"][0]["mesh"] = 0.0;
  file.root["accessors"][0]["count"] = 3.0;
  file.root["accessors"][0]["componentType"] = 5126.0;
  EXPECT_EQ(count_triangles(file.load()), 1u);
}

TEST(Extensions, UnknownAndRequiredIsRefusedByName) {
  GltfBuilder file = triangle_file();
  file.root["extensionsRequired"] = {"KHR_materials_unlit", "ACME_strange"};
  EXPECT_THAT(file.refused(), AllOf(HasSubstr("extensionsRequired"), HasSubstr("ACME_strange")));
}

TEST(Extensions, UnknownAndUsedIsOneWarning) {
  GltfBuilder file = triangle_file();
  file.root["extensionsUsed"] = {"KHR_materials_unlit", "ACME_strange", "ACME_strange"};
  EXPECT_THAT(file.load().warnings, ElementsAre(HasSubstr("ACME_strange")));
}

TEST(Extensions, AllOursAreAccepted) {
  GltfBuilder file = triangle_file();
  for (const char* name :
       {"KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_ior",
        "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_volume",
        "KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_unlit", "KHR_materials_variants",
        "KHR_lights_punctual", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
        "KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    file.root["extensionsRequired"].push_back(name);
    file.root["extensionsUsed"].push_back(name);
  }
  EXPECT_TRUE(file.load().warnings.empty());
}

TEST(Buffers, OutsideTheFolderAreRefused) {
  for (const char* uri :
       {"../data.bin", "/etc/passwd", "https://example.com/data.bin", "data:no-comma", ""}) {
    GltfBuilder file = triangle_file();
    file.root["buffers"] = {{{"byteLength", 4}, {"uri", uri}}};
    file.root.erase("bufferViews");
    file.root.erase("accessors");
    file.root["meshes"] = json::array();
    file.root["nodes"][0].erase("mesh");
    EXPECT_THAT(file.refused(), HasSubstr("buffers[0].uri")) << uri;
  }
}

TEST(Buffers, WithoutASourceAreRefusedWhenRead) {
  GltfBuilder file = triangle_file();
  file.root["buffers"] = {{{"byteLength", 1000}}};
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.gltf", text_bytes(file.root.dump()));
  EXPECT_THAT(refusal(folder.path() / "test.gltf"), HasSubstr("has no data"));
}

}  // namespace
}  // namespace gatelight::scene
