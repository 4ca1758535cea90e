#include <gtest/gtest.h>

#include <limits>

#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

/// A triangle whose texture coordinates are read, because its material has a (missing) texture.
struct Textured {
  GltfBuilder file;
  json primitive;

  Textured() {
    file.add("images", {{"uri", "absent.png"}});
    file.add("textures", {{"source", 0}});
    file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    primitive = {{"attributes", {{"POSITION", file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}}},
                 {"material", 0}};
  }

  Mesh load(int uv) {
    primitive["attributes"]["TEXCOORD_0"] = uv;
    file.node({{"mesh", file.mesh(primitive)}});
    return only_mesh(file.load({.missing_is_error = false}));
  }
};

template <typename T>
void expect_uvs(int type, const std::vector<T>& values, bool normalized, const std::vector<float>& expected) {
  Textured t;
  const Mesh mesh = t.load(t.file.accessor(values, type, "VEC2", 3, {{"normalized", normalized}}));
  ASSERT_EQ(mesh.uv0.size(), 3u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_FLOAT_EQ(mesh.uv0[i / 2][static_cast<int>(i % 2)], expected[i])
        << "type " << type << " entry " << i;
  }
}

TEST(Accessors, NormalisedIntegersMapToUnitRange) {
  expect_uvs<std::uint8_t>(kUnsignedByte, {0, 255, 51, 102, 204, 1}, true,
                           {0, 1, 0.2f, 0.4f, 0.8f, 1.0f / 255});
  expect_uvs<std::uint16_t>(kUnsignedShort, {0, 65535, 13107, 26214, 52428, 1}, true,
                            {0, 1, 0.2f, 0.4f, 0.8f, 1.0f / 65535});
  expect_uvs<std::int8_t>(kByte, {0, 127, -127, -128, 64, -1}, true,
                          {0, 1, -1, -1, 64.0f / 127, -1.0f / 127});
  expect_uvs<std::int16_t>(kShort, {0, 32767, -32767, -32768, 1, -1}, true,
                           {0, 1, -1, -1, 1.0f / 32767, -1.0f / 32767});
}

TEST(Accessors, QuantizedIntegersKeepTheirValue) {
  expect_uvs<std::uint8_t>(kUnsignedByte, {0, 255, 3, 4, 5, 6}, false, {0, 255, 3, 4, 5, 6});
  expect_uvs<std::int16_t>(kShort, {-5, 300, 3, 4, 5, 6}, false, {-5, 300, 3, 4, 5, 6});
}

TEST(Accessors, PositionsMayBeQuantized) {
  GltfBuilder file;
  // Padded to 8 bytes per element, as KHR_mesh_quantization requires.
  const int view =
      file.view(std::vector<std::int16_t>{0, 0, 0, 0, 100, 0, 0, 0, 0, -200, 7, 0}, {{"byteStride", 8}});
  const int position = accessor_of_view(file, view, kShort, "VEC3", 3);
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", position}}}})}, {"scale", {0.01, 0.01, 0.01}}});
  file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  const Scene scene = file.load();
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_TRUE(only_mesh(scene).positions[1].isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(only_mesh(scene).positions[2].isApprox(Vec3(0, -2, 0.07f)));
}

TEST(Accessors, InterleavedAttributesShareAView) {
  GltfBuilder file;
  std::vector<float> data;
  for (int i = 0; i < 3; ++i) {
    for (const float f : {i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f, 0.0f}) data.push_back(f);
    for (int axis = 0; axis < 3; ++axis) data.push_back(axis == i ? 2.0f : 0.0f);
  }
  const int view = file.view(data, {{"byteStride", 24}});
  const int position = accessor_of_view(file, view, kFloat, "VEC3", 3);
  const int normal = accessor_of_view(file, view, kFloat, "VEC3", 3, {{"byteOffset", 12}});
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}})}});
  const Mesh mesh = only_mesh(file.load());
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[2], Vec3(0, 1, 0));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.normals[static_cast<std::size_t>(i)], Vec3(Vec3::Unit(i))) << "normalised";
  }
}

TEST(Accessors, SparseEntriesReplaceValues) {
  GltfBuilder file;
  const json sparse = sparse_entries(file, std::vector<std::uint16_t>{1, 2}, kUnsignedShort,
                                     std::vector<float>{5, 0, 0, 0, 6, 0});
  const int based =
      file.accessor(std::vector<float>{1, 1, 1, 2, 2, 2, 3, 3, 3}, kFloat, "VEC3", 3, {{"sparse", sparse}});
  const int unbased = zeros(file, kFloat, "VEC3", 3, {{"sparse", sparse}});
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", based}}}})}});
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", unbased}}}})}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions[0], Vec3(1, 1, 1));
  EXPECT_EQ(scene.meshes[0].positions[1], Vec3(5, 0, 0));
  EXPECT_EQ(scene.meshes[0].positions[2], Vec3(0, 6, 0));
  EXPECT_EQ(scene.meshes[1].positions[0], Vec3(0, 0, 0));
  EXPECT_EQ(scene.meshes[1].positions[2], Vec3(0, 6, 0));
}

TEST(Accessors, SparseIndexBufferIsRead) {
  GltfBuilder file;
  const json sparse =
      sparse_entries(file, std::vector<std::uint8_t>{1, 2}, kUnsignedByte, std::vector<std::uint16_t>{2, 1});
  json primitive = file.triangle();
  primitive["indices"] = zeros(file, kUnsignedShort, "SCALAR", 3, {{"sparse", sparse}});
  file.node({{"mesh", file.mesh(primitive)}});
  const std::array<std::uint32_t, 3> expected = {0, 2, 1};
  EXPECT_EQ(only_mesh(file.load()).triangles.at(0), expected);
}

TEST(Accessors, WithoutAViewAreZeros) {
  Textured t;
  const Mesh mesh = t.load(zeros(t.file, kFloat, "VEC2", 3));
  ASSERT_EQ(mesh.uv0.size(), 3u);
  for (const Vec2& uv : mesh.uv0) EXPECT_EQ(uv, Vec2(0, 0));
  GltfBuilder file;
  json primitive = file.triangle();
  primitive["indices"] = zeros(file, kUnsignedShort, "SCALAR", 3);
  file.node({{"mesh", file.mesh(primitive)}});
  EXPECT_EQ(file.refused(), "");
}

TEST(Accessors, AllIndexTypesGiveTheSameTriangle) {
  const auto load = [](auto zero, int type) {
    using T = decltype(zero);
    GltfBuilder file;
    json primitive = file.triangle();
    primitive["indices"] = file.accessor(std::vector<T>{2, 0, 1}, type, "SCALAR", 3);
    file.node({{"mesh", file.mesh(primitive)}});
    return only_mesh(file.load()).triangles.at(0);
  };
  const std::array<std::uint32_t, 3> expected = {2, 0, 1};
  EXPECT_EQ(load(std::uint8_t{}, kUnsignedByte), expected);
  EXPECT_EQ(load(std::uint16_t{}, kUnsignedShort), expected);
  EXPECT_EQ(load(std::uint32_t{}, kUnsignedInt), expected);
}

TEST(Accessors, ColorsComeInThreeOrFourComponentsAndAnyType) {
  const auto load = [](auto values, int type, const char* kind) {
    GltfBuilder file;
    json primitive = file.triangle();
    primitive["attributes"]["COLOR_0"] =
        file.accessor(values, type, kind, 3, {{"normalized", type != kFloat}});
    file.node({{"mesh", file.mesh(primitive)}});
    return only_mesh(file.load()).colors;
  };
  const auto rgb = load(std::vector<float>{1, 0, 0, 0, 0.5f, 0, 0, 0, 1}, kFloat, "VEC3");
  ASSERT_EQ(rgb.size(), 3u);
  EXPECT_EQ(rgb[1], Vec4(0, 0.5f, 0, 1)) << "alpha is one where the file has none";
  const auto rgba =
      load(std::vector<std::uint8_t>{255, 0, 0, 51, 0, 0, 0, 0, 0, 0, 0, 0}, kUnsignedByte, "VEC4");
  EXPECT_TRUE(rgba[0].isApprox(Vec4(1, 0, 0, 0.2f)));
  EXPECT_TRUE(load(std::vector<float>(9, 1.0f), kFloat, "VEC3").empty()) << "white changes nothing";
}

TEST(Accessors, UnusedTextureCoordinatesAreDropped) {
  EXPECT_TRUE(only_mesh(triangle_file().load()).uv0.empty());
}

/// Changes one number of a file that loads; every change must be refused.
struct Damage {
  const char* pointer;  ///< into the JSON
  json value;
  const char* names;
};

GltfBuilder undamaged_file() {
  GltfBuilder file;
  const int position = file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const json sparse =
      sparse_entries(file, std::vector<std::uint16_t>{1}, kUnsignedShort, std::vector<float>{1, 0, 0});
  const int normal =
      file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3, {{"sparse", sparse}});
  json primitive = {{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"mode", 4}};
  primitive["indices"] = file.indices({0, 1, 2});
  file.node({{"mesh", file.mesh(primitive)},
             {"camera", 0},
             {"translation", {0, 0, 0}},
             {"scale", {1, 1, 1}},
             {"rotation", {0, 0, 0, 1}}});
  file.add("cameras",
           {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}, {"aspectRatio", 1.5}}}});
  file.root["scene"] = 0;
  name_buffers(file);
  return file;
}

const double kHuge = 1e300;
const Damage kDamages[] = {
    {"/accessors/0/count", -1, "accessors[0].count"},
    {"/accessors/0/count", 4, "accessors[0]"},
    {"/accessors/0/count", 4611686018427387904, "count"},
    {"/accessors/0/count", 1.5, "accessors[0].count"},
    {"/accessors/0/count", kHuge, "count"},
    {"/accessors/0/byteOffset", -4, "byteOffset"},
    {"/accessors/0/byteOffset", 4, "accessors[0]"},
    {"/accessors/0/byteOffset", 9007199254740992, "accessors[0]"},
    {"/accessors/0/bufferView", 99, "bufferView"},
    {"/accessors/0/bufferView", -1, "bufferView"},
    {"/accessors/0/componentType", 5124, "componentType"},
    {"/accessors/0/componentType", 5125, "accessors[0]"},
    {"/accessors/0/type", "VEC2", "accessors[0]"},
    {"/accessors/0/type", "VEC5", "type"},
    {"/accessors/2/componentType", 5126, "accessors[2]"},
    {"/accessors/2/type", "VEC2", "accessors[2]"},
    {"/accessors/1/sparse/count", 2, "sparse"},
    {"/accessors/1/sparse/count", 4, "sparse"},
    {"/accessors/1/sparse/indices/bufferView", 77, "sparse.indices"},
    {"/accessors/1/sparse/indices/byteOffset", 1, "sparse.indices"},
    {"/accessors/1/sparse/values/byteOffset", 4, "sparse.values"},
    {"/accessors/1/sparse/indices/componentType", 5126, "componentType"},
    {"/bufferViews/0/buffer", 1, "bufferViews[0].buffer"},
    {"/bufferViews/0/byteOffset", 100000, "bufferViews[0]"},
    {"/bufferViews/0/byteLength", 100000, "bufferViews[0]"},
    {"/bufferViews/0/byteLength", 0, "accessors[0]"},
    {"/bufferViews/0/byteLength", -8, "byteLength"},
    {"/bufferViews/0/byteStride", 3, "byteStride"},
    {"/bufferViews/0/byteStride", 8, "byteStride"},
    {"/bufferViews/0/byteStride", 256, "accessors[0]"},
    {"/bufferViews/0/byteStride", 24, "accessors[0]"},
    {"/buffers/0/byteLength", 10, "bufferViews"},
    {"/meshes/0/primitives/0/indices", 9, "indices"},
    {"/meshes/0/primitives/0/material", 0, "material"},
    {"/meshes/0/primitives/0/attributes/POSITION", 50, "POSITION"},
    {"/meshes/0/primitives", 3, "primitives"},
    {"/nodes/0/mesh", 1, "nodes[0].mesh"},
    {"/nodes/0/children", json::array({0}), "nodes[0]"},
    {"/nodes/0/children", json::array({8}), "children[0]"},
    {"/nodes/0/translation", json::array({1, 2}), "translation"},
    {"/nodes/0/translation/1", 1e39, "translation"},
    {"/nodes/0/translation/1", "x", "translation"},
    {"/nodes/0/translation/1", 1e30, "1e+30"},
    {"/nodes/0/scale/1", 3e38, "3e+38"},
    {"/nodes/0/matrix", json::array({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2}), "matrix"},
    {"/scenes/0/nodes/0", 5, "scenes[0].nodes[0]"},
    {"/cameras/0/perspective/yfov", 0, "yfov"},
    {"/cameras/0/perspective/yfov", 4, "yfov"},
    {"/cameras/0/type", "fisheye", "type"},
    {"/asset/version", "1.0", "asset.version"},
    {"/asset/version", 1, "assimp export"},
    {"/asset/minVersion", "2.1", "minVersion"},
    {"/accessors/0", "text", "accessors[0]"},
    {"/nodes", 5, "nodes"}};

TEST(DamagedFile, IsRefusedInOneLine) {
  EXPECT_EQ(undamaged_file().refused(), "");
  for (const Damage& damage : kDamages) {
    SCOPED_TRACE(::testing::Message() << damage.pointer << " = " << damage.value);
    GltfBuilder file = undamaged_file();
    file.root[json::json_pointer(damage.pointer)] = damage.value;
    file.expect_refused({damage.names});
  }
}

TEST(Accessors, NonFinitePositionsAreRefused) {
  for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    GltfBuilder file;
    file.node({{"mesh",
                file.mesh({{"attributes", {{"POSITION", file.positions({0, 0, 0, 1, 0, 0, 0, bad, 0})}}}})}});
    file.expect_refused({"meshes[0].primitives[0]", "position 2"});
  }
}

TEST(Accessors, SparseIndexBeyondTheCountIsRefused) {
  GltfBuilder file;
  const json sparse =
      sparse_entries(file, std::vector<std::uint8_t>{3}, kUnsignedByte, std::vector<float>{5, 0, 0});
  const int position = zeros(file, kFloat, "VEC3", 3, {{"sparse", sparse}});
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", position}}}})}});
  file.expect_refused({"accessors[0].sparse.indices", "index 3"});
}

}  // namespace
}  // namespace gatelight::scene
