// Morph targets and skins in the pose of the file, against positions that follow from the specification.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;
using Floats = std::vector<float>;

const Floats kNormals{0, 0, 1, 0, 0, 1, 0, 0, 1};

/// Column by column.
Floats translation(float x, float y, float z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

int vectors(GltfBuilder& file, const Floats& rows) {
  return file.accessor(rows, kFloat, "VEC3", rows.size() / 3);
}

/// Adds a mesh of a triangle with these changes of its positions; `weights` may be null.
void add_morphs(GltfBuilder& file, const std::vector<Floats>& targets, const json& weights) {
  json primitive = file.triangle();
  for (const Floats& target : targets) primitive["targets"].push_back({{"POSITION", vectors(file, target)}});
  const int mesh = file.mesh(primitive);
  if (!weights.is_null()) file.root["meshes"][static_cast<std::size_t>(mesh)]["weights"] = weights;
}

/// A triangle whose vertices follow two joints by these weights of four a vertex.
json skinned_triangle(GltfBuilder& file, const std::vector<std::uint8_t>& joints, const Floats& weights) {
  json primitive = file.triangle();
  primitive["attributes"]["NORMAL"] = vectors(file, kNormals);
  primitive["attributes"]["JOINTS_0"] = file.accessor(joints, kUnsignedByte, "VEC4", 3);
  primitive["attributes"]["WEIGHTS_0"] = file.accessor(weights, kFloat, "VEC4", 3);
  return primitive;
}

/// The first joint stands at the origin, the second has these properties.
void add_skin(GltfBuilder& file, const json& second, json more = json::object()) {
  const int first = file.node({{"name", "first"}});
  const int other = file.node(second);
  json skin = {{"joints", {first, other}}};
  skin.update(more);
  file.add("skins", skin);
}

/// Adds a mesh of the primitive that follows such a skin.
void add_skinned(GltfBuilder& file, const json& primitive, const json& second, json more = json::object()) {
  const int mesh = file.mesh(primitive);
  add_skin(file, second, std::move(more));
  file.node({{"mesh", mesh}, {"skin", 0}});
}

const std::vector<std::uint8_t> kBothJoints{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
const Floats kOfSecond{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};  ///< weights

/// A mesh whose vertices follow the second joint of a skin, which has these properties.
GltfBuilder following_second(const json& second, const Floats& weights = kOfSecond,
                             const std::vector<std::uint8_t>& joints = kBothJoints) {
  GltfBuilder file;
  add_skinned(file, skinned_triangle(file, joints, weights), second);
  return file;
}

TEST(Morphs, TargetsAddUpByTheWeightsOfTheMesh) {
  GltfBuilder file;
  add_morphs(file, {{2, 0, 0, 2, 0, 0, 2, 0, 0}, {0, 0, 4, 0, 0, 0, 0, 0, 0}}, {0.5, 0.25});
  file.node({{"mesh", 0}});
  const Scene scene = file.load();
  EXPECT_EQ(only_mesh(scene).positions[0], Vec3(1, 0, 1));
  EXPECT_EQ(only_mesh(scene).positions[1], Vec3(2, 0, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Morphs, WeightsOfTheNodeReplaceThoseOfTheMesh) {
  GltfBuilder file;
  add_morphs(file, {{2, 0, 0, 2, 0, 0, 2, 0, 0}}, {1.0});
  file.node({{"mesh", 0}, {"weights", {0.25}}});
  file.node({{"mesh", 0}});
  file.node({{"mesh", 0}, {"weights", {0.0}}});
  file.node({{"mesh", 0}, {"translation", {0, 0, 7}}});
  const Scene scene = file.load({.bake_transforms = false});
  ASSERT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.mesh_of(scene.instances[0]).positions[0], Vec3(0.5f, 0, 0));
  EXPECT_EQ(scene.mesh_of(scene.instances[1]).positions[0], Vec3(2, 0, 0));
  EXPECT_EQ(scene.mesh_of(scene.instances[2]).positions[0], Vec3(0, 0, 0));
  EXPECT_EQ(scene.instances[3].mesh, scene.instances[1].mesh) << "equal poses share their vertices";
  EXPECT_EQ(scene.meshes.size(), 3u);
}

TEST(Morphs, MissingWeightsAreZeroAndFurtherOnesCountNothing) {
  GltfBuilder file;
  add_morphs(file, {{1, 0, 0, 1, 0, 0, 1, 0, 0}, {0, 1, 0, 0, 1, 0, 0, 1, 0}}, nullptr);
  file.node({{"mesh", 0}, {"weights", {1}}});
  file.node({{"mesh", 0}, {"weights", {1, 1, 1}}});
  const Scene scene = file.load();
  EXPECT_EQ(scene.meshes[0].positions[0], Vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes[1].positions[0], Vec3(1, 1, 0));
}

TEST(Morphs, TargetsMayBeSparseAndQuantised) {
  GltfBuilder file;
  json primitive = file.triangle();
  const json entries = sparse_entries(file, std::vector<std::uint16_t>{2}, kUnsignedShort, Floats{0, 0, 3});
  const int sparse = zeros(file, kFloat, "VEC3", 3, {{"sparse", entries}});
  // Three shorts a vertex, in rows of eight bytes.
  const std::vector<std::int16_t> shorts{32767, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const int view = file.view(shorts, {{"byteStride", 8}});
  const int quantised = accessor_of_view(file, view, kShort, "VEC3", 3, {{"normalized", true}});
  primitive["targets"] = {{{"POSITION", sparse}}, {{"POSITION", quantised}}};
  file.add("meshes", {{"primitives", {primitive}}, {"weights", {1.0, 2.0}}});
  file.node({{"mesh", 0}});
  const Scene scene = file.load();
  EXPECT_EQ(only_mesh(scene).positions[2], Vec3(0, 1, 3));
  EXPECT_EQ(only_mesh(scene).positions[0], Vec3(2, 0, 0));
}

TEST(Morphs, NormalsFollow) {
  GltfBuilder file;
  json primitive = file.triangle();
  primitive["attributes"]["NORMAL"] = vectors(file, kNormals);
  primitive["targets"] = {{{"NORMAL", vectors(file, {1, 0, 0, 0, 0, 0, 0, 0, 0})}}};
  file.add("meshes", {{"primitives", {primitive}}, {"weights", {1.0}}});
  file.node({{"mesh", 0}});
  const Scene scene = file.load();
  EXPECT_TRUE(only_mesh(scene).normals[0].isApprox(Vec3(1, 0, 1).normalized(), 1e-6f));
  EXPECT_EQ(only_mesh(scene).normals[1], Vec3(0, 0, 1));
}

TEST(Morphs, ATargetOfAnotherLengthIsRefused) {
  GltfBuilder file;
  add_morphs(file, {{1, 0, 0}}, {1.0});
  file.node({{"mesh", 0}});
  file.expect_refused({"POSITION", "1", "3"});
}

TEST(Skins, VerticesFollowTheirJointsAndNotTheirNode) {
  GltfBuilder file;
  const Floats weights{1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0};
  const int mesh = file.mesh(skinned_triangle(file, kBothJoints, weights));
  Floats inverses = translation(0, 0, 0);
  const Floats second = translation(0, -5, 0);
  inverses.insert(inverses.end(), second.begin(), second.end());
  const int matrices = file.accessor(inverses, kFloat, "MAT4", 2);
  // The second joint stood at y = 5 in the bind pose, and has moved by 4 along z.
  add_skin(file, {{"translation", {0, 5, 4}}}, {{"inverseBindMatrices", matrices}});
  file.node({{"mesh", mesh}, {"skin", 0}, {"translation", {100, 100, 100}}});
  const Scene scene = file.load();
  const Mesh& m = only_mesh(scene);
  EXPECT_EQ(m.positions[0], Vec3(0, 0, 0));
  EXPECT_EQ(m.positions[1], Vec3(1, 0, 4));
  EXPECT_EQ(m.positions[2], Vec3(0, 1, 2));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Skins, JointsInheritFromTheirParents) {
  GltfBuilder file;
  const int mesh = file.mesh(skinned_triangle(file, kBothJoints, kOfSecond));
  const int first = file.node({{"name", "first"}});
  const float s = std::sqrt(0.5f);
  const int child = file.add("nodes", {{"translation", {2, 0, 0}}});
  // A quarter turn about z.
  file.node({{"children", {child}}, {"rotation", {0, 0, s, s}}});
  file.add("skins", {{"joints", {first, child}}});
  file.node({{"mesh", mesh}, {"skin", 0}});
  const Mesh m = only_mesh(file.load());
  EXPECT_TRUE(m.positions[0].isApprox(Vec3(0, 2, 0), 1e-6f));
  EXPECT_TRUE(m.positions[1].isApprox(Vec3(0, 3, 0), 1e-6f));
}

TEST(Skins, WeightsAreDividedByTheirSum) {
  const Floats weights{0, 0.25, 0, 0, 0, 8, 0, 0, 0, 0, 0, 0};
  const Mesh m = only_mesh(following_second({{"translation", {0, 0, 4}}}, weights).load());
  EXPECT_EQ(m.positions[0], Vec3(0, 0, 4));
  EXPECT_EQ(m.positions[1], Vec3(1, 0, 4));
  EXPECT_EQ(m.positions[2], Vec3(0, 1, 0)) << "no weights: the first joint";
}

TEST(Skins, EverySetOfJointsCounts) {
  GltfBuilder file;
  json primitive = skinned_triangle(file, kBothJoints, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  primitive["attributes"]["JOINTS_1"] = file.accessor(
      std::vector<std::uint16_t>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kUnsignedShort, "VEC4", 3);
  const std::vector<std::uint8_t> bytes{255, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0};
  primitive["attributes"]["WEIGHTS_1"] =
      file.accessor(bytes, kUnsignedByte, "VEC4", 3, {{"normalized", true}});
  add_skinned(file, primitive, {{"translation", {0, 0, 4}}});
  const Mesh m = only_mesh(file.load());
  EXPECT_EQ(m.positions[0], Vec3(0, 0, 2));
  EXPECT_EQ(m.positions[1], Vec3(1, 0, 0));
}

TEST(Skins, NormalsStayPerpendicularUnderUnevenScale) {
  GltfBuilder file;
  json primitive = skinned_triangle(file, kBothJoints, kOfSecond);
  const Vec3 n = Vec3(1, 1, 0).normalized();
  primitive["attributes"]["POSITION"] = vectors(file, {0, 0, 0, 1, -1, 0, 0, 0, -1});
  primitive["attributes"]["NORMAL"] = vectors(file, {n.x(), n.y(), 0, n.x(), n.y(), 0, n.x(), n.y(), 0});
  add_skinned(file, primitive, {{"scale", {4, 1, 1}}});
  const Mesh m = only_mesh(file.load());
  const Vec3 edge = m.positions[1] - m.positions[0];
  EXPECT_NEAR(m.normals[0].dot(edge.normalized()), 0.0f, 1e-6f);
  EXPECT_GT(m.normals[0].dot(n), 0.0f);
  EXPECT_NEAR(m.normals[0].norm(), 1.0f, 1e-6f);
}

TEST(Skins, MirroredJointsKeepFrontFacesAndNormalsTogether) {
  const Mesh m = only_mesh(following_second({{"scale", {-1, 1, 1}}}).load());
  const auto& t = m.triangles[0];
  const Vec3 front = (m.positions[t[1]] - m.positions[t[0]]).cross(m.positions[t[2]] - m.positions[t[0]]);
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
  EXPECT_GT(front.dot(m.normals[0]), 0.0f);
}

TEST(Skins, SingularJointsFlattenWithoutNonFiniteNumbers) {
  const Floats weights{0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  const Mesh m =
      only_mesh(following_second({{"scale", {0, 0, 0}}, {"translation", {3, 3, 3}}}, weights).load());
  EXPECT_EQ(m.positions[0], Vec3(3, 3, 3));
  EXPECT_EQ(m.positions[2], Vec3(0, 1, 0));
  for (const Vec3& n : m.normals) EXPECT_NEAR(n.norm(), 1.0f, 1e-5f);
}

TEST(Skins, OneSkinServesSeveralMeshesAndOneMeshSeveralSkins) {
  GltfBuilder file;
  const int a = file.mesh(skinned_triangle(file, kBothJoints, kOfSecond));
  const int b = file.mesh(skinned_triangle(file, kBothJoints, kOfSecond));
  add_skin(file, {{"translation", {1, 0, 0}}});
  add_skin(file, {{"translation", {2, 0, 0}}});
  file.node({{"mesh", a}, {"skin", 0}});
  file.node({{"mesh", b}, {"skin", 0}});
  file.node({{"mesh", a}, {"skin", 1}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.meshes[0].positions[0], Vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes[1].positions[0], Vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes[2].positions[0], Vec3(2, 0, 0));
}

TEST(Skins, MorphsComeBeforeTheSkin) {
  GltfBuilder file;
  json primitive = skinned_triangle(file, kBothJoints, kOfSecond);
  primitive["targets"] = {{{"POSITION", vectors(file, {1, 0, 0, 1, 0, 0, 1, 0, 0})}}};
  file.add("meshes", {{"primitives", {primitive}}, {"weights", {1.0}}});
  const float s = std::sqrt(0.5f);
  add_skin(file, {{"rotation", {0, 0, s, s}}});
  file.node({{"mesh", 0}, {"skin", 0}});
  EXPECT_TRUE(only_mesh(file.load()).positions[0].isApprox(Vec3(0, 1, 0), 1e-6f));
}

TEST(Skins, AMeshWithoutJointsFollowsTheFirstOneWithAWarning) {
  GltfBuilder file;
  const int mesh = file.mesh(file.triangle());
  const int joint = file.node({{"translation", {0, 5, 0}}});
  file.add("skins", {{"joints", {joint}}});
  file.node({{"mesh", mesh}, {"skin", 0}, {"translation", {100, 100, 100}}});
  const Scene scene = file.load();
  EXPECT_EQ(only_mesh(scene).positions[0], Vec3(0, 5, 0));
  expect_messages(scene.warnings, {{"joints", "weights"}});
}

TEST(Skins, AJointThatIsNotThereIsRefusedWhereItHasWeight) {
  const auto file_with = [](float weight) {
    std::vector<std::uint8_t> joints = kBothJoints;
    joints[2] = 7;
    return following_second({{"translation", {0, 0, 4}}}, {1, 0, weight, 0, 1, 0, 0, 0, 1, 0, 0, 0}, joints);
  };
  file_with(0.5f).expect_refused({"JOINTS_0", "7", "2"});
  EXPECT_EQ(only_mesh(file_with(0.0f).load()).positions[0], Vec3(0, 0, 0));
}

TEST(Skins, TooFewInverseBindMatricesAreRefused) {
  GltfBuilder file;
  const int matrices = file.accessor(translation(0, 0, 0), kFloat, "MAT4", 1);
  add_skinned(file, skinned_triangle(file, kBothJoints, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}),
              {{"translation", {0, 0, 4}}}, {{"inverseBindMatrices", matrices}});
  file.expect_refused({"inverse bind matrices", "1", "2"});
}

TEST(Skins, TenThousandJointsInAChainKeepTheirPlaces) {
  GltfBuilder file;
  const int count = 10000;
  std::vector<std::uint16_t> joints(12, 0);
  joints[0] = joints[4] = joints[8] = count - 1;
  json primitive = file.triangle();
  primitive["attributes"]["JOINTS_0"] = file.accessor(joints, kUnsignedShort, "VEC4", 3);
  primitive["attributes"]["WEIGHTS_0"] =
      file.accessor(Floats{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kFloat, "VEC4", 3);
  const int mesh = file.mesh(primitive);
  const int skinned = file.node({{"mesh", mesh}, {"skin", 0}});
  json list = json::array();
  for (int i = 0; i < count; ++i) {
    json node = {{"translation", {0.5, 0, 0}}};
    const int number = skinned + 1 + i;
    if (i + 1 < count) node["children"] = {number + 1};
    i == 0 ? file.node(node) : file.add("nodes", node);
    list.push_back(number);
  }
  file.add("skins", {{"joints", list}});
  const Scene scene = file.load();
  EXPECT_EQ(Vec3(scene.origin + only_mesh(scene).positions[0]), Vec3(0.5f * count, 0, 0));
}

}  // namespace
}  // namespace gatelight::scene
