// tinygltf reads what the schema has accepted: files on which tinygltf alone would crash, or take memory
// without limit, are refused or load.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

TEST(Tinygltf, AnyChunksAndLengthsOfAGlbAreRead) {
  GltfBuilder file = triangle_file();
  std::vector<std::uint8_t> bytes = file.glb();
  const std::size_t json_end = 20 + (bytes[12] | static_cast<std::size_t>(bytes[13]) << 8);
  const std::vector<std::uint8_t> chunk = {1, 0, 0, 0, 'A', 'C', 'M', 'E', 7};
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(json_end), chunk.begin(), chunk.end());
  for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.glb", bytes);
  EXPECT_EQ(refusal(folder.path() / "test.glb"), "");
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
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.gltf", {text.begin(), text.end()});
  expect_refused(folder.path() / "test.gltf", {"JSON", "MiB", std::to_string(text.size())});
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
