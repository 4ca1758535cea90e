#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

using ::testing::ElementsAre;
using tests::expect_messages;
using Triangle = std::array<std::uint32_t, 3>;

/// Loads five vertices of a convex polygon, with a mode and optional indices.
Scene load_polygon(int mode, const std::vector<std::uint32_t>& indices) {
  GltfBuilder file;
  json primitive = {
      {"attributes", {{"POSITION", file.positions({0, 0, 0, 1, 0, 0, 2, 1, 0, 1, 2, 0, 0, 1, 0})}}},
      {"mode", mode}};
  if (!indices.empty()) primitive["indices"] = file.indices(indices);
  file.node({{"mesh", file.mesh(primitive)}});
  return file.load();
}

TEST(Topology, StripsAlternateTheirWindingAndFansTurnAroundTheFirstVertex) {
  EXPECT_THAT(load_polygon(5, {}).meshes.at(0).triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}, Triangle{2, 3, 4}));
  EXPECT_THAT(load_polygon(6, {}).meshes.at(0).triangles,
              ElementsAre(Triangle{1, 2, 0}, Triangle{2, 3, 0}, Triangle{3, 4, 0}));
  EXPECT_THAT(load_polygon(5, {4, 3, 2, 1, 0}).meshes.at(0).triangles,
              ElementsAre(Triangle{4, 3, 2}, Triangle{3, 1, 2}, Triangle{2, 1, 0}));
  EXPECT_THAT(load_polygon(6, {4, 0, 1, 2, 3}).meshes.at(0).triangles,
              ElementsAre(Triangle{0, 1, 4}, Triangle{1, 2, 4}, Triangle{2, 3, 4}));
}

TEST(Topology, IndicesThatAreNoWholeTriangleAreCutWithAWarning) {
  const Scene scene = load_polygon(4, {});
  EXPECT_THAT(scene.meshes.at(0).triangles, ElementsAre(Triangle{0, 1, 2}));
  expect_messages(scene.warnings, {{"5"}});
}

TEST(Topology, PointsAndLinesAreLeftOutWithOneWarning) {
  GltfBuilder file;
  for (const int mode : {0, 1, 2, 3, 4}) {
    json primitive = file.triangle();
    primitive["mode"] = mode;
    file.node({{"mesh", file.mesh(primitive)}});
  }
  const Scene scene = file.load();
  EXPECT_EQ(count_triangles(scene), 1u);
  expect_messages(scene.warnings, {{"points", "lines"}});
}

TEST(Topology, TooFewVerticesForATriangleAreNoTriangle) {
  const Scene scene = load_polygon(5, {0, 1});
  EXPECT_EQ(count_triangles(scene), 0u);
  EXPECT_TRUE(scene.bounds.isEmpty());
}

TEST(Topology, DegenerateTrianglesAreKept) {
  EXPECT_EQ(load_polygon(4, {0, 0, 1, 2, 2, 2}).meshes.at(0).triangles.size(), 2u);
}

TEST(Topology, AnIndexBeyondTheVerticesIsRefused) {
  for (const int mode : {4, 5, 6}) {
    GltfBuilder file;
    json primitive = file.triangle();
    primitive["indices"] = file.indices({0, 1, 3});
    primitive["mode"] = mode;
    file.node({{"mesh", file.mesh(primitive)}});
    file.expect_refused({"meshes[0].primitives[0]", "index 3", "triangle 0"});
  }
}

TEST(Topology, VerticesThatNoTriangleUsesAreDropped) {
  // The loader renumbers in two ways: for few of many vertices, and for most of them.
  const Scene few = load_polygon(4, {3, 4, 1});
  EXPECT_THAT(few.meshes.at(0).positions, ElementsAre(Vec3(1, 0, 0), Vec3(1, 2, 0), Vec3(0, 1, 0)));
  EXPECT_THAT(few.meshes.at(0).triangles, ElementsAre(Triangle{1, 2, 0}));
  const Scene most = load_polygon(4, {3, 4, 1, 0, 1, 4});
  EXPECT_EQ(most.meshes.at(0).positions.size(), 4u);
  EXPECT_EQ(most.meshes.at(0).positions[most.meshes.at(0).triangles[0][0]], Vec3(1, 2, 0));
  GltfBuilder sparse;
  std::vector<float> many(300 * 3, 0.0f);
  for (std::size_t i = 0; i < 300; ++i) many[i * 3] = static_cast<float>(i);
  json primitive = {{"attributes", {{"POSITION", sparse.positions(many)}}}};
  primitive["indices"] = sparse.indices({299, 7, 100});
  sparse.node({{"mesh", sparse.mesh(primitive)}});
  const Mesh mesh = only_mesh(sparse.load());
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3(7, 0, 0), Vec3(100, 0, 0), Vec3(299, 0, 0)));
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{2, 0, 1}));
}

TEST(Topology, BrokenNormalsAreReplacedByTriangleNormals) {
  GltfBuilder file;
  json primitive = file.triangle();
  primitive["attributes"]["NORMAL"] =
      file.accessor(std::vector<float>{0, 0, 0, NAN, 0, 0, 0, 3, 4}, kFloat, "VEC3", 3);
  file.node({{"mesh", file.mesh(primitive)}});
  const Scene scene = file.load();
  EXPECT_EQ(scene.meshes[0].normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(scene.meshes[0].normals[1], Vec3(0, 0, 1));
  EXPECT_TRUE(scene.meshes[0].normals[2].isApprox(Vec3(0, 0.6f, 0.8f)));
  expect_messages(scene.warnings, {{"normals"}});
}

TEST(Topology, MissingNormalsStayMissing) {
  EXPECT_TRUE(only_mesh(triangle_file().load()).normals.empty());
}

// A file of some hundred bytes could contain counts that need gigabytes.
TEST(Claims, TooMuchGeometryForTheFileIsRefused) {
  const auto with_primitives = [](int primitives, std::size_t count) {
    GltfBuilder file;
    const int accessor = zeros(file, kFloat, "VEC3", count);
    json list = json::array();
    for (int i = 0; i < primitives; ++i) list.push_back({{"attributes", {{"POSITION", accessor}}}});
    file.node({{"mesh", file.add("meshes", {{"primitives", list}})}});
    return file;
  };
  EXPECT_EQ(with_primitives(3, 999).refused(), "");
  with_primitives(1, (1 << 20) + 1).expect_refused({"accessors[0]", "1048577"});
  with_primitives(20, 1 << 20).expect_refused({"meshes[0].primitives[13]", "1024"});
}

TEST(Claims, TooManyInstancesForTheFileAreRefused) {
  const auto with_nodes = [](int nodes, std::size_t count, int primitives) {
    GltfBuilder file;
    const json places = {{"TRANSLATION", zeros(file, kFloat, "VEC3", count)}};
    json list = json::array();
    for (int i = 0; i < primitives; ++i) list.push_back(file.triangle());
    const int mesh = file.add("meshes", {{"primitives", list}});
    for (int i = 0; i < nodes; ++i) file.node({{"mesh", mesh}, {"extensions", instancing(places)}});
    return file;
  };
  EXPECT_EQ(with_nodes(2, 100, 2).refused(), "");
  with_nodes(10, 1 << 20, 1).expect_refused({"EXT_mesh_gpu_instancing", "MiB"});
  with_nodes(1, 1 << 18, 200).expect_refused({"meshes[0]", "MiB"});
}

}  // namespace
}  // namespace gatelight::scene
