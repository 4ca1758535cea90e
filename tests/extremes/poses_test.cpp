// Poses: many joints and none, weights of any sum, joints without an inverse, targets of nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace gatelight::scene {
namespace {

using Floats = std::vector<float>;

/// Joint i is at (i, 0, 0) and moves by (0, 1, 0) from its bind pose.
GltfBuilder with_joints(int count) {
  GltfBuilder file;
  json joints = json::array();
  Floats inverses;
  for (int i = 0; i < count; ++i) {
    joints.push_back(file.node({{"translation", {i, 1, 0}}}));
    const Floats inverse{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, static_cast<float>(-i), 0, 0, 1};
    inverses.insert(inverses.end(), inverse.begin(), inverse.end());
  }
  json skin = {{"joints", joints}};
  if (count > 0)
    skin["inverseBindMatrices"] = file.accessor(inverses, kFloat, "MAT4", static_cast<std::size_t>(count));
  file.add("skins", skin);
  return file;
}

/// Triangles of this many vertices, each with the joint of its number.
json skinned(GltfBuilder& file, int vertices, const Floats& weights) {
  Floats positions;
  std::vector<std::uint16_t> joints;
  Floats all;
  for (int i = 0; i < vertices; ++i) {
    for (const float x : {static_cast<float>(i), 0.0f, static_cast<float>(i % 3)}) positions.push_back(x);
    for (int c = 0; c < 4; ++c) joints.push_back(static_cast<std::uint16_t>(i));
    all.insert(all.end(), weights.begin(), weights.end());
  }
  const auto count = static_cast<std::size_t>(vertices);
  return {{"attributes",
           {{"POSITION", file.positions(positions)},
            {"JOINTS_0", file.accessor(joints, kUnsignedShort, "VEC4", count)},
            {"WEIGHTS_0", file.accessor(all, kFloat, "VEC4", count)}}}};
}

/// The largest distance of a vertex from its place, which is one above that of the bind pose.
float worst_place(const Scene& scene) {
  float worst = 0.0f;
  for (const Vec3& p : only_mesh(scene).positions) worst = std::max(worst, std::abs(p.y() - 1.0f));
  return worst;
}

TEST(Poses, NoJointsAndTenThousand) {
  GltfBuilder none = with_joints(0);
  none.node({{"mesh", none.mesh(none.triangle())}, {"skin", 0}});
  const Scene unmoved = none.load();
  EXPECT_EQ(unmoved.bounds.max(), Vec3(1, 1, 0));
  EXPECT_EQ(unmoved.warnings.size(), 1u);
  constexpr int kJoints = 10'000, kVertices = 9999;
  GltfBuilder file = with_joints(kJoints);
  file.node({{"mesh", file.mesh(skinned(file, kVertices, {1, 0, 0, 0}))}, {"skin", 0}});
  const Scene scene = file.load();
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(count_triangles(scene), 3333u);
  EXPECT_EQ(worst_place(scene), 0.0f);
}

TEST(Poses, WeightsOfAnySum) {
  for (const float scale : {1e-30f, 1e-3f, 0.5f, 1.0f, 3.0f, 1e30f}) {
    GltfBuilder file = with_joints(3);
    file.node({{"mesh", file.mesh(skinned(file, 3, {0.5f * scale, 0.25f * scale, 0.25f * scale, 0}))},
               {"skin", 0}});
    EXPECT_LT(worst_place(file.load()), 1e-6f) << scale;
  }
  GltfBuilder file = with_joints(3);
  file.node({{"mesh", file.mesh(skinned(file, 3, {0, -1, std::nanf(""), 0}))}, {"skin", 0}});
  EXPECT_LT(worst_place(file.load()), 1e-6f) << "the first joint";
}

TEST(Poses, JointsWithoutAnInverse) {
  for (const json& scale : {json{0, 0, 0}, json{1, 0, 1}, json{0, 0, 1}, json{1e-20, 1e-20, 1e-20},
                            json{-1, 1, 1}, json{1e4, 1, 1e-4}}) {
    GltfBuilder file = with_joints(3);
    for (int i = 0; i < 3; ++i) file.root["nodes"][i]["scale"] = scale;
    json primitive = skinned(file, 3, {1, 0, 0, 0});
    primitive["attributes"]["NORMAL"] =
        file.accessor(Floats{0, 1, 0, 0, 1, 0, 0.6f, 0.8f, 0}, kFloat, "VEC3", 3);
    file.node({{"mesh", file.mesh(primitive)}, {"skin", 0}});
    const Scene scene = file.load();
    for (const Vec3& p : only_mesh(scene).positions) EXPECT_TRUE(p.allFinite()) << scale;
    for (const Vec3& n : only_mesh(scene).normals) EXPECT_NEAR(n.norm(), 1.0f, 1e-5f) << scale;
  }
}

TEST(Poses, TargetsOfNothingAndOfEverything) {
  GltfBuilder file;
  json primitive = file.triangle();
  primitive["targets"] = {json::object(),
                          {{"POSITION", file.positions({0, 0, 1, 0, 0, 1, 0, 0, 1})}},
                          {{"NORMAL", file.positions({0, 0, 1, 0, 0, 1, 0, 0, 1})}}};
  json empty = {
      {"attributes",
       {{"POSITION", file.add("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 0}})}}}};
  empty["targets"] = {{{"POSITION", file.positions({})}}};
  file.add("meshes", {{"primitives", {primitive, empty}}, {"weights", {1, 1e-40, 1, 5, 5, 5}}});
  file.node({{"mesh", 0}});
  Scene scene = file.load();
  EXPECT_EQ(count_triangles(scene), 1u);
  EXPECT_LT(scene.bounds.max().z(), 1e-30f);
  EXPECT_EQ(scene.warnings.size(), 1u) << "the empty primitive";
  file.root["meshes"][0]["weights"][1] = 1e8;
  scene = file.load();
  EXPECT_EQ(scene.origin.z() + scene.bounds.max().z(), 1e8f) << "its centre became the origin";
  file.root["meshes"][0]["weights"][1] = 1e30;
  file.expect_refused({"1e+30"});
}

}  // namespace
}  // namespace gatelight::scene
