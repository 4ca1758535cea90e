#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>

#include "scene/gltf/color_filter.h"
#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

constexpr int kGrid = 9;

/// A wavy sheet of kGrid x kGrid vertices.
std::vector<float> sheet_positions() {
  std::vector<float> xyz;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      xyz.push_back(static_cast<float>(x));
      xyz.push_back(static_cast<float>(y));
      xyz.push_back(std::sin(static_cast<float>(x + 2 * y)));
    }
  }
  return xyz;
}

std::vector<std::uint32_t> sheet_indices() {
  std::vector<std::uint32_t> list;
  for (std::uint32_t y = 0; y + 1 < kGrid; ++y) {
    for (std::uint32_t x = 0; x + 1 < kGrid; ++x) {
      const std::uint32_t i = y * kGrid + x;
      for (const std::uint32_t k : {i, i + 1, i + kGrid, i + 1, i + kGrid + 1, i + kGrid}) list.push_back(k);
    }
  }
  return list;
}

/// Returns a mesh as the set of its triangles, each from its smallest corner on, because compressors reorder.
std::set<std::vector<long>> triangle_set(const Mesh& mesh, float grid) {
  std::set<std::vector<long>> result;
  for (const auto& t : mesh.triangles) {
    std::array<std::vector<long>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) corners[k].push_back(std::lround(mesh.positions[t[k]][c] / grid));
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::vector<long> flat;
    for (const auto& corner : corners) flat.insert(flat.end(), corner.begin(), corner.end());
    result.insert(flat);
  }
  return result;
}

Mesh plain_sheet() {
  GltfBuilder file;
  json primitive = {{"attributes", {{"POSITION", file.positions(sheet_positions())}}}};
  primitive["indices"] = file.indices(sheet_indices());
  file.node({{"mesh", file.mesh(primitive)}});
  return only_mesh(file.load());
}

/// Adds a view that is compressed, and returns its index. Its decoded data belong to buffer 1, a fallback.
int compressed_view(GltfBuilder& file, const std::string& extension, const std::vector<std::uint8_t>& packed,
                    std::size_t count, std::size_t stride, const json& mode) {
  const auto packed_view = static_cast<std::size_t>(file.view(packed));
  const json offset = file.root["bufferViews"][packed_view]["byteOffset"];
  json view = {{"buffer", 1}, {"byteLength", count * stride}};
  view["extensions"][extension] = {{"buffer", 0},
                                   {"byteOffset", offset},
                                   {"byteLength", packed.size()},
                                   {"byteStride", stride},
                                   {"count", count}};
  view["extensions"][extension].update(mode);
  return file.add("bufferViews", view);
}

std::vector<std::uint8_t> packed_vertices(const void* data, std::size_t count, std::size_t stride) {
  std::vector<std::uint8_t> packed(meshopt_encodeVertexBufferBound(count, stride));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), data, count, stride));
  return packed;
}

GltfBuilder meshopt_sheet(const std::string& index_mode,
                          const std::string& extension = "EXT_meshopt_compression") {
  GltfBuilder file;
  file.root["extensionsRequired"] = {extension};
  const std::vector<float> xyz = sheet_positions();
  const std::vector<std::uint32_t> list = sheet_indices();
  const std::size_t vertices = xyz.size() / 3;
  std::vector<std::uint8_t> indices;
  if (index_mode == "TRIANGLES") {
    indices.resize(meshopt_encodeIndexBufferBound(list.size(), vertices));
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), list.data(), list.size()));
  } else {
    indices.resize(meshopt_encodeIndexSequenceBound(list.size(), vertices));
    indices.resize(meshopt_encodeIndexSequence(indices.data(), indices.size(), list.data(), list.size()));
  }
  const int vertex_view = compressed_view(file, extension, packed_vertices(xyz.data(), vertices, 12),
                                          vertices, 12, {{"mode", "ATTRIBUTES"}});
  const int index_view = compressed_view(file, extension, indices, list.size(), 2, {{"mode", index_mode}});
  name_buffers(file,
               json::array({{{"byteLength", 1 << 20}, {"extensions", {{extension, {{"fallback", true}}}}}}}));
  json primitive;
  primitive["attributes"]["POSITION"] = accessor_of_view(file, vertex_view, kFloat, "VEC3", vertices);
  primitive["indices"] = accessor_of_view(file, index_view, kUnsignedShort, "SCALAR", list.size());
  file.node({{"mesh", file.mesh(primitive)}});
  return file;
}

TEST(Meshopt, DecodesToThePlainMesh) {
  const Mesh plain = plain_sheet();
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
      GltfBuilder file = meshopt_sheet(mode, extension);
      const Mesh mesh = only_mesh(file.load());
      EXPECT_EQ(mesh.positions, plain.positions) << mode;
      EXPECT_EQ(triangle_set(mesh, 1e-4f), triangle_set(plain, 1e-4f)) << mode;
    }
  }
}

/// Colours in YCoCg, four values each, with the formula of the extension's appendix B.
std::vector<double> ycocg_to_rgba(const std::vector<int>& values, int bits, double greatest) {
  std::vector<double> rgba;
  const double scale = greatest / (std::pow(2.0, bits) - 1.0);
  for (std::size_t i = 0; i < values.size(); i += 4) {
    const double y = values[i], co = values[i + 1], cg = values[i + 2];
    const int low = values[i + 3] - (1 << (bits - 1));
    for (const double value : {y + co - cg, y + cg, y - co - cg, 2.0 * low + low % 2})
      rgba.push_back(value * scale);
  }
  return rgba;
}

/// All colours of a coarse grid in `bits` bits, as an encoder writes them. Co and Cg lose their last bit.
std::vector<int> grid_of_colors(int bits) {
  std::vector<int> values;
  const int most = (1 << bits) - 1;
  const auto at = [&](int k) { return k * most / 3; };
  for (int k = 0; k < 64; ++k) {
    const int r = at(k / 16), g = at(k / 4 % 4), b = at(k % 4);
    const int co = (r - b) / 2, rest = b + co, cg = (g - rest) / 2, y = rest + cg;
    values.insert(values.end(), {y, co, cg, (1 << (bits - 1)) + (most >> 1) * (k % 4) / 3});
  }
  return values;
}

template <class Channel>
void expect_color_filter(int bits) {
  const std::vector<int> values = grid_of_colors(bits);
  std::vector<Channel> channels;
  for (const int value : values) channels.push_back(static_cast<Channel>(value));
  std::vector<std::uint8_t> bytes(channels.size() * sizeof(Channel));
  std::memcpy(bytes.data(), channels.data(), bytes.size());
  gltf::decode_color_filter(bytes, 4 * sizeof(Channel));
  std::memcpy(channels.data(), bytes.data(), bytes.size());
  const double greatest = std::numeric_limits<Channel>::max();
  const std::vector<double> expected = ycocg_to_rgba(values, bits, greatest);
  for (std::size_t i = 0; i < channels.size(); ++i)
    EXPECT_NEAR(channels[i], std::clamp(expected[i], 0.0, greatest), 0.501) << bits << " bits, value " << i;
}

TEST(Meshopt, ColorFilterFollowsItsFormula) {
  for (const int bits : {2, 5, 8}) expect_color_filter<std::uint8_t>(bits);
  for (const int bits : {2, 8, 11, 16}) expect_color_filter<std::uint16_t>(bits);
  std::vector<std::uint8_t> wrong = {255, 127, 128, 0, 0, 128, 127, 1};  // no alpha tells the bits
  gltf::decode_color_filter(wrong, 4);
}

TEST(Meshopt, ColorFilterGivesColors) {
  // White, red, green and half transparent blue; 8 bits a channel.
  const std::vector<std::uint8_t> filtered = {255, 0, 0,   255, 64, 127, 192, 255,
                                              128, 0, 127, 255, 64, 129, 192, 128 + 64};
  GltfBuilder file;
  json primitive = {{"attributes", {{"POSITION", file.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})}}}};
  primitive["indices"] = file.indices({0, 1, 2, 0, 2, 3});
  const int decoded = compressed_view(file, "KHR_meshopt_compression", packed_vertices(filtered.data(), 4, 4),
                                      4, 4, {{"mode", "ATTRIBUTES"}, {"filter", "COLOR"}});
  name_buffers(file, json::array({{{"byteLength", 16}}}));
  primitive["attributes"]["COLOR_0"] =
      accessor_of_view(file, decoded, kUnsignedByte, "VEC4", 4, {{"normalized", true}});
  file.node({{"mesh", file.mesh(primitive)}});
  const Mesh mesh = only_mesh(file.load());
  const std::vector<Vec4> expected = {{1, 1, 1, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0.5f}};
  ASSERT_EQ(mesh.colors.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LE((mesh.colors[i] - expected[i]).cwiseAbs().maxCoeff(), 1.6f / 255.0f) << i;
}

TEST(Meshopt, DataOfANewerLibraryIsNamed) {
  if (MESHOPTIMIZER_VERSION >= 230) GTEST_SKIP() << "this library reads it";
  GltfBuilder file = meshopt_sheet("TRIANGLES", "KHR_meshopt_compression");
  const json& view = file.root["bufferViews"][1]["extensions"]["KHR_meshopt_compression"];
  file.bin[view["byteOffset"].get<std::size_t>()] = 0xa1;
  file.expect_refused(
      {"bufferViews[1].extensions.KHR_meshopt_compression", "version 1", "version 0", "libmeshoptimizer"});
}

TEST(Meshopt, OctahedralFilterGivesNormals) {
  const std::vector<float> normals = {0, 0.6f, 0.8f, 0, 1, 0, 0, 0, -0.28f, 0.96f, 0, 0};
  std::vector<std::uint8_t> filtered(3 * 8);
  meshopt_encodeFilterOct(filtered.data(), 3, 8, 16, normals.data());
  GltfBuilder file;
  json primitive = file.triangle();
  const int decoded = compressed_view(file, "EXT_meshopt_compression", packed_vertices(filtered.data(), 3, 8),
                                      3, 8, {{"mode", "ATTRIBUTES"}, {"filter", "OCTAHEDRAL"}});
  file.root["bufferViews"].back()["byteStride"] = 8;
  name_buffers(file, json::array({{{"byteLength", 24}}}));
  primitive["attributes"]["NORMAL"] =
      accessor_of_view(file, decoded, kShort, "VEC3", 3, {{"normalized", true}});
  file.node({{"mesh", file.mesh(primitive)}});
  const Mesh mesh = only_mesh(file.load());
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_TRUE(mesh.normals[0].isApprox(Vec3(0, 0.6f, 0.8f), 1e-3f));
  EXPECT_TRUE(mesh.normals[2].isApprox(Vec3(-0.28f, 0.96f, 0), 1e-3f));
}

TEST(Meshopt, BrokenDataAndCountsAreRefused) {
  GltfBuilder damaged = meshopt_sheet("TRIANGLES");
  damaged.bin[0] = 0x11;
  damaged.expect_refused({"bufferViews[1].extensions.EXT_meshopt_compression"});
  const auto expect_refused = [](const char* key, const json& value, tests::NameList names) {
    GltfBuilder file = meshopt_sheet("TRIANGLES");
    file.root["bufferViews"][1]["extensions"]["EXT_meshopt_compression"][key] = value;
    names.push_back("bufferViews[1].extensions.EXT_meshopt_compression");
    file.expect_refused(names);
  };
  expect_refused("count", 80, {"80"});
  expect_refused("byteStride", 10, {"byteStride", "10", "4"});
  expect_refused("byteLength", 1000000, {"1000000"});
  expect_refused("mode", "MAGIC", {"mode", "MAGIC", "ATTRIBUTES", "TRIANGLES", "INDICES"});
  expect_refused("filter", "QUATERNION", {"byteStride", "12", "8"});
  expect_refused("buffer", 1, {"buffer 1"});
  expect_refused("buffer", 2, {"buffer", "2"});
}

/// The sheet as Draco data, positions in 14 bits.
std::vector<std::uint8_t> draco_sheet(int& position_id) {
  const std::vector<float> xyz = sheet_positions();
  const std::vector<std::uint32_t> list = sheet_indices();
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(list.size() / 3));
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t f = 0; f < list.size() / 3; ++f) {
    builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(f), &xyz[list[f * 3] * 3],
                                      &xyz[list[f * 3 + 1] * 3], &xyz[list[f * 3 + 2] * 3]);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  position_id = static_cast<int>(mesh->attribute(attribute)->unique_id());
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}

GltfBuilder draco_file() {
  GltfBuilder file;
  int id = 0;
  const int view = file.view(draco_sheet(id));
  json primitive;
  primitive["attributes"]["POSITION"] = zeros(file, kFloat, "VEC3", kGrid * kGrid);
  primitive["indices"] = zeros(file, kUnsignedShort, "SCALAR", sheet_indices().size());
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                           {"attributes", {{"POSITION", id}}}};
  file.node({{"mesh", file.mesh(primitive)}});
  file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

TEST(Draco, DecodesToThePlainMesh) {
  const Mesh mesh = only_mesh(draco_file().load());
  EXPECT_EQ(mesh.triangles.size(), sheet_indices().size() / 3);
  // 14 bits over 8 units: a step of 5e-4.
  EXPECT_EQ(triangle_set(mesh, 0.05f), triangle_set(plain_sheet(), 0.05f));
}

TEST(Draco, BrokenDataIsRefused) {
  GltfBuilder file = draco_file();
  file.bin[8] ^= 0xff;
  file.expect_refused({"KHR_draco_mesh_compression"});
  GltfBuilder cut = draco_file();
  cut.root["bufferViews"][0]["byteLength"] = 40;
  cut.expect_refused({"KHR_draco_mesh_compression"});
  GltfBuilder wrong = draco_file();
  wrong.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
            ["POSITION"] = 7;
  wrong.expect_refused({"POSITION", "7"});
}

TEST(Draco, TheSampleBoxIsAUnitCube) {
  const char* scenes = std::getenv("GATELIGHT_SCENES");
  if (!scenes) GTEST_SKIP() << "GATELIGHT_SCENES is not set";
  const Scene scene = load_gltf(std::filesystem::path(scenes) / "gltf-features/BoxDraco/BoxDraco.gltf");
  EXPECT_EQ(count_triangles(scene), 12u);
  EXPECT_TRUE(scene.bounds.min().isApprox(Vec3::Constant(-0.5f), 1e-3f));
  EXPECT_TRUE(scene.bounds.max().isApprox(Vec3::Constant(0.5f), 1e-3f));
  EXPECT_EQ(scene.meshes.at(0).normals.size(), scene.meshes.at(0).positions.size());
  for (const Instance& instance : scene.instances) {
    for (std::uint32_t i = 0; i < 12; ++i) {
      EXPECT_GT(world_normal(scene, instance, i).dot(world_triangle(scene, instance, i)[0]), 0.0f)
          << "faces outwards";
    }
  }
}

}  // namespace
}  // namespace gatelight::scene
