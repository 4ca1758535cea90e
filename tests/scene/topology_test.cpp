// Meshes: their triangles, the frames of a single triangle, and the memory behind their positions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstring>
#include <utility>

#include "base/padded_vector.h"
#include "scene/scene.h"
#include "scene/tangents.h"
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

/// Returns a unit quad in the plane z = 0 that faces +z. `uv` is for its corners (0,0) (1,0) (1,1) (0,1).
Mesh quad(const std::vector<Vec2>& uv) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, Vec3::UnitZ());
  mesh.uv0 = uv;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TextureSlot slot() {
  TextureSlot s;
  s.texture = 0;
  return s;
}

void expect_frame(const Mesh& mesh, std::size_t vertex, const Vec3& tangent, const Vec3& bitangent) {
  const Vec3 t = mesh.tangents.at(vertex).head<3>();
  const Vec3 n = mesh.normals.empty() ? Vec3(Vec3::UnitZ()) : mesh.normals[vertex];
  EXPECT_TRUE(t.isApprox(tangent, 1e-5f)) << t.transpose();
  EXPECT_TRUE(Vec3(n.cross(t) * mesh.tangents[vertex].w()).isApprox(bitangent, 1e-5f));
}

TEST(Tangents, FollowUAndTheUpDirectionOfThePicture) {
  Mesh mesh = quad({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  Mesh mirrored = quad({{1, 1}, {0, 1}, {0, 0}, {1, 0}});
  generate_tangents(mesh, slot());
  generate_tangents(mirrored, slot());
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    expect_frame(mesh, i, Vec3::UnitX(), Vec3::UnitY());
    EXPECT_EQ(mesh.tangents[i].w(), 1.0f);
    expect_frame(mirrored, i, -Vec3::UnitX(), Vec3::UnitY());
    EXPECT_EQ(mirrored.tangents[i].w(), -1.0f);
  }
}

TEST(Tangents, TheTextureTransformTurnsTheFrame) {
  Mesh mesh = quad({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  TextureSlot turned = slot();
  turned.transform << 0, 1, 0, -1, 0, 0;  // a quarter turn: u grows downwards on the quad
  generate_tangents(mesh, turned);
  expect_frame(mesh, 0, -Vec3::UnitY(), Vec3::UnitX());
}

TEST(Tangents, FlatMeshesGetAFrameForEachTriangle) {
  Mesh mesh = quad({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  mesh.normals.clear();
  mesh.positions[3].z() = 5.0f;
  generate_tangents(mesh, slot());
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.triangles[1][2], 5u);
  EXPECT_EQ(mesh.positions[5], Vec3(0, 1, 5));
  for (const Vec4& t : mesh.tangents) EXPECT_NEAR(t.head<3>().norm(), 1.0f, 1e-5f);
}

TEST(Tangents, WithoutAGradientOfCoordinatesTheyLieInTheTriangle) {
  Mesh degenerate = quad(std::vector<Vec2>(4, Vec2(0.5f, 0.5f)));
  Mesh ramp = degenerate;
  degenerate.positions[2] = degenerate.positions[1];
  ramp.normals.clear();
  for (Vec3& p : ramp.positions) p.z() = -p.x();
  for (auto& [mesh, normal] : {std::pair(&degenerate, Vec3(0, 0, 1)), std::pair(&ramp, Vec3(1, 0, 1))}) {
    generate_tangents(*mesh, slot());
    for (const Vec4& t : mesh->tangents) {
      EXPECT_NEAR(t.head<3>().norm(), 1.0f, 1e-5f);
      EXPECT_NEAR(t.head<3>().dot(normal), 0.0f, 1e-5f);
    }
  }
}

GltfBuilder with_normal_map() {
  GltfBuilder file = triangle_of({{"normalTexture", {{"index", 0}}}});
  file.add("images", {{"uri", "absent.png"}});
  file.add("textures", {{"source", 0}});
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
  attributes["TANGENT"] =
      file.accessor(std::vector<float>{0, 2, 0, -1, 0, 2, 0, -1, 0, 0, 0, 0}, kFloat, "VEC4", 3);
  return file;
}

TEST(Tangents, TangentsOfTheFileAreUsedWhenANormalMapNeedsThem) {
  GltfBuilder file = with_normal_map();
  const LoadOptions options{.missing_is_error = false};
  const Mesh own = only_mesh(file.load(options));
  EXPECT_TRUE(own.tangents.at(0).isApprox(Vec4(0, 1, 0, -1)));
  EXPECT_NEAR(own.tangents.at(2).head<3>().norm(), 1.0f, 1e-5f) << "repaired";
  file.root["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
  EXPECT_TRUE(only_mesh(file.load(options)).tangents.at(0).isApprox(Vec4(1, 0, 0, 1))) << "generated";
  file.root["materials"][0] = json::object();
  EXPECT_TRUE(only_mesh(file.load(options)).tangents.empty()) << "unused";
}

TEST(Tangents, AllThatNeedsAFrameGetsTheSame) {
  GltfBuilder file = with_normal_map();
  file.root["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
  const LoadOptions options{.missing_is_error = false};
  const std::vector<Vec4> expected = only_mesh(file.load(options)).tangents;
  file.root["materials"][0] = {{"extensions", {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}}}}};
  EXPECT_EQ(only_mesh(file.load(options)).tangents, expected);
  file.root["materials"][0] = {{"extensions",
                                {{"KHR_materials_clearcoat",
                                  {{"clearcoatFactor", 1.0}, {"clearcoatNormalTexture", {{"index", 0}}}}}}}};
  EXPECT_EQ(only_mesh(file.load(options)).tangents, expected);
}

/// Expects that 16 bytes can be read at the last position and belong to the vector. For six positions, 72
/// bytes, the C library's allocator would give no more than requested; the address sanitizer checks the read.
void expect_padding(const Mesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), 6u);
  float read[4];
  std::memcpy(read, mesh.positions.data() + 5, sizeof(read));
  EXPECT_EQ(read[0], 5.0f);
  EXPECT_GE(malloc_usable_size(const_cast<Vec3*>(mesh.positions.data())), 5 * sizeof(Vec3) + sizeof(read));
}

Mesh six_positions() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  return mesh;
}

TEST(PaddedVector, ReadsOf16BytesStayInsideAfterCopiesMovesAndResizes) {
  Mesh mesh = six_positions();
  expect_padding(mesh);
  const Mesh copied = mesh;
  expect_padding(copied);
  Mesh assigned;
  assigned = copied;
  expect_padding(assigned);
  mesh.positions.resize(100);
  mesh.positions.resize(6);
  mesh.positions.shrink_to_fit();
  expect_padding(mesh);
  Mesh moved = std::move(mesh);
  expect_padding(moved);
  mesh = six_positions();
  expect_padding(mesh);
  mesh = std::move(moved);
  expect_padding(mesh);
  moved = copied;
  expect_padding(moved);
  std::vector<Mesh> grown(1, copied);
  grown.resize(9);
  expect_padding(grown.front());
}

}  // namespace
}  // namespace gatelight::scene
