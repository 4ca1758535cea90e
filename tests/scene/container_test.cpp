// Containers and buffers. tinygltf reads what the schema has accepted: files on which tinygltf alone would
// crash, or take memory without limit, are refused or load.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/gltf_parts.h"
#include "tests/support/small_pngs.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;

Scene load_bytes(const std::vector<std::uint8_t>& bytes) {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.glb", bytes);
  return load_gltf(folder.path() / "test.glb");
}

void expect_refused_bytes(const std::vector<std::uint8_t>& bytes, const tests::NameList& names) {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.glb", bytes);
  expect_refused(folder.path() / "test.glb", names);
}

void expect_refused_text(const std::string& text, const tests::NameList& names = {}) {
  const TemporaryFolder folder;
  expect_refused(folder.write("test.gltf", text), names);
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
  folder.write("a.gltf", root.dump(2));
  root["buffers"][0]["uri"] = "data%20file.bin";
  folder.write("b.gltf", root.dump());
  write_bytes(folder.path() / "data file.bin", file.bin);
  root["buffers"][0]["uri"] = "DATA:;Base64," + base64(file.bin);
  folder.write("c.gltf", root.dump());
  for (const char* name : {"a.gltf", "b.gltf", "c.gltf"}) {
    EXPECT_EQ(only_mesh(load_gltf(folder.path() / name)).positions, binary.positions) << name;
  }
}

TEST(Container, MessagesNameTheFileFirst) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "nowhere.glb").string();
  EXPECT_EQ(refusal(path).find(path + ": "), 0u);
  expect_refused(path, {});
  expect_refused(folder.path(), {});
}

TEST(Container, BrokenHeadersAreRefused) {
  const std::vector<std::uint8_t> whole = triangle_file().glb();
  const auto with = [&](std::size_t offset, std::uint8_t value) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[offset] = value;
    return bytes;
  };
  EXPECT_EQ(triangle_file().refused(), "");
  expect_refused_bytes({}, {});
  expect_refused_bytes({'g', 'l', 'T', 'F', 2}, {"5", "12"});
  expect_refused_bytes(with(0, 'x'), {"glTF"});
  expect_refused_bytes(with(4, 1), {"1", "2"});
  const std::string size = std::to_string(whole.size());
  expect_refused_bytes(with(15, 0x7f), {"chunk 0", std::to_string(whole.size() - 20)});
  expect_refused_bytes(with(16, 0), {"JSON"});
}

TEST(Container, WrongLengthsAreReplacedWithAWarningWhileTheContentIsThere) {
  const std::vector<std::uint8_t> whole = triangle_file().glb();
  const auto expect_warning = [&](std::size_t offset, std::uint8_t value, const tests::NameList& names) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[offset] = value;
    expect_messages(load_bytes(bytes).warnings, {names});
  };
  expect_warning(11, 0x7f, {"header", std::to_string(whole.size())});
  const std::size_t json_bytes = whole[12] | static_cast<std::size_t>(whole[13]) << 8;
  expect_warning(20 + json_bytes + 3, 0x7f, {"chunk 1", "length"});
  expect_refused_bytes({whole.begin(), whole.end() - 32}, {"accessors[0]"});
}

TEST(Container, BytesAfterTheEndAreIgnoredWithAWarning) {
  std::vector<std::uint8_t> bytes = triangle_file().glb();
  bytes.resize(bytes.size() + 5);
  expect_messages(load_bytes(bytes).warnings, {{"5"}});
}

TEST(Container, TextThatIsNotGltfIsRefusedInOneLine) {
  for (const char* text :
       {"{", "[]", "null", "{}", "{\"asset\":{}}", "\xff\xfe{}", "{\"asset\":{\"version\":\"2.0\"},}",
        "{\n\"asset\":\n1e999}", "{\"asset\":{\"version\":\"2.0\\n3\"}}"}) {
    expect_refused_text(text);
  }
}

TEST(Container, DeepNestingIsRefused) {
  const std::string deep = "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(1000000, '[');
  expect_refused_text(deep, {"100"});
}

TEST(Container, NumbersMayBeWrittenWithAFraction) {
  GltfBuilder file = triangle_file();
  file.root["nodes"][0]["mesh"] = 0.0;
  file.root["accessors"][0]["count"] = 3.0;
  file.root["accessors"][0]["componentType"] = 5126.0;
  EXPECT_EQ(count_triangles(file.load()), 1u);
}

TEST(Extensions, UnknownAndUsedIsOneWarning) {
  GltfBuilder file = triangle_file();
  file.root["extensionsUsed"] = {"KHR_materials_unlit", "ACME_strange", "ACME_strange"};
  expect_messages(file.load().warnings, {{"ACME_strange"}});
}

TEST(Extensions, AllSupportedExtensionsAreAccepted) {
  GltfBuilder file = triangle_file();
  for (const char* name :
       {"KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_ior",
        "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_volume",
        "KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_unlit", "KHR_materials_variants",
        "KHR_lights_punctual", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
        "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    file.root["extensionsRequired"].push_back(name);
    file.root["extensionsUsed"].push_back(name);
  }
  EXPECT_TRUE(file.load().warnings.empty());
}

TEST(Buffers, PathsOutsideTheFolderAreRefused) {
  for (const char* uri :
       {"../data.bin", "/etc/passwd", "https://example.com/data.bin", "data:no-comma", ""}) {
    GltfBuilder file = triangle_file();
    file.root["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", uri}}};
    file.expect_refused({"buffers[0].uri"});
  }
}

TEST(Buffers, EndAtTheirByteLengthInALargerFile) {
  GltfBuilder file = triangle_file();
  file.root["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", "data.bin"}}};
  const TemporaryFolder folder;
  file.bin.push_back(0);
  write_bytes(folder.path() / "data.bin", file.bin);
  folder.write("test.gltf", file.root.dump());
  EXPECT_EQ(refusal(folder.path() / "test.gltf"), "");
  json& last = file.root["bufferViews"].back();
  last["byteLength"] = last["byteLength"].get<int>() + 1;
  folder.write("test.gltf", file.root.dump());
  expect_refused(folder.path() / "test.gltf", {"bufferViews[1]"});
  last["byteLength"] = 24;
  const std::size_t held = file.bin.size();
  file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
      {"buffer", 0}, {"byteLength", held}, {"byteStride", 4}, {"count", 6}, {"mode", "ATTRIBUTES"}};
  file.root["extensionsUsed"] = {"EXT_meshopt_compression"};
  folder.write("test.gltf", file.root.dump());
  expect_refused(folder.path() / "test.gltf",
                 {fmt::format("{} bytes at 0", held), fmt::format("at most {}", held - 1)});
}

/// The folder of a scene within another one.
struct SceneFolder {
  TemporaryFolder outer;
  std::filesystem::path inner = outer.path() / "scene";

  explicit SceneFolder(const char* picture_outside) {
    std::filesystem::create_directory(inner);
    write_bytes(outer.path() / picture_outside, kGrey);
  }
  /// The path of a scene in the inner folder, or in `folder`.
  std::filesystem::path with(const std::string& uri, std::filesystem::path folder = {}) const {
    if (folder.empty()) folder = inner;
    write_bytes(folder / "test.glb", with_image({{"uri", uri}}).glb());
    return folder / "test.glb";
  }
};

TEST(Images, PathsOutsideTheFolderAreRefused) {
  const SceneFolder folder("secret.png");
  const auto& [outer, inner] = folder;
  for (const std::string& uri :
       {std::string("../secret.png"), std::string("%2e%2e/secret.png"), std::string("a/../../secret.png"),
        (outer.path() / "secret.png").string(), "file://" + (outer.path() / "secret.png").string(),
        std::string("http://localhost/secret.png"), std::string("secret.png%00.png"),
        std::string("..\\secret.png")}) {
    expect_refused(folder.with(uri), {"images[0].uri", uri});
  }
  write_bytes(inner / "own.png", kGrey);
  EXPECT_EQ(refusal(folder.with("sub/../own.png")), "");
}

TEST(Images, ALinkOutOfTheFolderIsRefusedAndALinkWithinIsNot) {
  const SceneFolder folder("secret.png");
  const auto& [outer, inner] = folder;
  write_bytes(inner / "own.png", kGrey);
  std::filesystem::create_symlink("../secret.png", inner / "link.png");
  std::filesystem::create_symlink(outer.path(), inner / "up");
  std::filesystem::create_symlink("own.png", inner / "other.png");
  std::filesystem::create_symlink("none.png", inner / "dangling.png");
  for (const char* uri : {"link.png", "up/secret.png", "up/scene/link.png", "%6cink.png"}) {
    expect_refused(folder.with(uri), {"images[0].uri", uri, "`allow-external`"});
  }
  expect_refused(folder.with("dangling.png"), {"images[0]", "dangling.png"});
  EXPECT_EQ(refusal(folder.with("other.png")), "");
  EXPECT_EQ(refusal(folder.with("up/scene/own.png")), "");
  // The folder itself may be reached by a link.
  std::filesystem::create_symlink("scene", outer.path() / "scene-link");
  EXPECT_EQ(refusal(folder.with("other.png", outer.path() / "scene-link")), "");
}

TEST(Images, FilesOfOtherFoldersAreReadWhereThatIsAllowed) {
  const SceneFolder folder("grey 1.png");
  const auto& [outer, inner] = folder;
  std::filesystem::create_symlink("../grey 1.png", inner / "link.png");
  const std::string absolute = outer.path().string() + "/grey%201.png";
  for (const std::string& uri :
       {std::string("../grey 1.png"), std::string("%2e%2e/grey%201.png"), std::string("link.png"), absolute,
        "file://" + absolute, "FILE://localhost" + absolute, "file:" + absolute}) {
    EXPECT_EQ(refusal(folder.with(uri), {.allow_external = true}), "") << uri;
  }
  for (const char* host : {"http://localhost", "file://elsewhere"}) {
    expect_refused(folder.with(host + absolute), {"images[0].uri", host}, {.allow_external = true});
  }
}

TEST(Buffers, WithoutASourceAreRefusedWhenRead) {
  GltfBuilder file = triangle_file();
  file.root["buffers"] = {{{"byteLength", 1000}}};
  expect_refused_text(file.root.dump(), {"accessors[0]", "buffer 0"});
}

TEST(Tinygltf, AnyChunksAndLengthsOfAGlbAreRead) {
  GltfBuilder file = triangle_file();
  std::vector<std::uint8_t> bytes = file.glb();
  const std::size_t json_end = 20 + (bytes[12] | static_cast<std::size_t>(bytes[13]) << 8);
  const std::vector<std::uint8_t> chunk = {1, 0, 0, 0, 'A', 'C', 'M', 'E', 7};
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(json_end), chunk.begin(), chunk.end());
  for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
  EXPECT_EQ(count_triangles(load_bytes(bytes)), 1u);
}

/// Each would get a copy of the .glb's data.
TEST(Tinygltf, BuffersWithoutASourceTakeNoMemory) {
  GltfBuilder file = triangle_file();
  file.bin.resize(std::size_t{1} << 20);
  file.root["buffers"] = {{{"byteLength", file.bin.size()}}};
  for (int i = 0; i < 10000; ++i) file.root["buffers"].push_back({{"byteLength", file.bin.size()}});
  EXPECT_EQ(file.refused(), "");
  file.root["bufferViews"][0]["buffer"] = 5;
  file.expect_refused({"accessors[0]", "buffer 5 has no data"});
}

TEST(Tinygltf, NamesOfFilesKeepTheirCharacters) {
  GltfBuilder file = triangle_file();
  file.root["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", "a+b%zz%20c.bin"}}};
  const TemporaryFolder folder;
  write_bytes(folder.path() / "a+b%zz c.bin", file.bin);
  EXPECT_EQ(refusal(file.write(folder)), "");
}

TEST(Tinygltf, DataUrisThatAreNotBase64AreRefused) {
  for (const char* body : {"QUJD*UJD", "QUJDQ", "QUJD=QUJD", "=QUJ", "QU%zz"}) {
    GltfBuilder file = triangle_file();
    file.root["buffers"] = {{{"byteLength", file.bin.size()},
                             {"uri", fmt::format("data:application/octet-stream;base64,{}", body)}}};
    file.expect_refused({"buffers[0].uri", "base64"});
  }
}

/// An object of three characters takes thousands of bytes in tinygltf's model.
TEST(Tinygltf, ManyEmptyObjectsAreRefused) {
  std::string text = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{}";
  for (int i = 0; i < 1000000; ++i) text += ",{}";
  text += "]}";
  expect_refused_text(text, {"JSON", "MiB", std::to_string(text.size())});
}

/// Values that the loader does not use are not kept, whatever they are.
TEST(Tinygltf, UnknownValuesAreIgnored) {
  GltfBuilder file =
      triangle_of({{"extensions", {{"ACME_strange", {{"a", {1, nullptr, "b"}}}}}}, {"extras", 5}});
  file.root["animations"] = "none";
  file.root["accessors"][0]["min"] = "small";
  file.root["images"] = {{{"uri", "absent.png"}, {"width", 1e300}}};
  file.root["extras"] = {1, 2};
  EXPECT_EQ(file.refused(), "");
}

}  // namespace
}  // namespace gatelight::scene
