// Poses: no joints, weights of any sum, targets of nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace gatelight::scene {
namespace {

using Floats = std::vector<float>;

/// A triangle whose vertices have these weights for joints that all move by (0, 1, 0).
Scene moved_up(const Floats& weights) {
  GltfBuilder file;
  json primitive = file.triangle(), joints = json::array();
  Floats all;
  for (int i = 0; i < 3; ++i) all.insert(all.end(), weights.begin(), weights.end());
  primitive["attributes"]["JOINTS_0"] = file.accessor(
      std::vector<std::uint16_t>{0, 1, 2, 0, 0, 1, 2, 0, 0, 1, 2, 0}, kUnsignedShort, "VEC4", 3);
  primitive["attributes"]["WEIGHTS_0"] = file.accessor(all, kFloat, "VEC4", 3);
  for (int i = 0; i < 3; ++i) joints.push_back(file.node({{"translation", {0, 1, 0}}}));
  file.add("skins", {{"joints", joints}});
  file.node({{"mesh", file.mesh(primitive)}, {"skin", 0}});
  return file.load();
}

TEST(Poses, NoJoints) {
  GltfBuilder file;
  file.add("skins", {{"joints", json::array()}});
  file.node({{"mesh", file.mesh(file.triangle())}, {"skin", 0}});
  const Scene unmoved = file.load();
  EXPECT_EQ(unmoved.bounds.max(), Vec3(1, 1, 0));
  EXPECT_EQ(unmoved.warnings.size(), 1u);
}

TEST(Poses, WeightsOfAnySum) {
  const auto expect_moved = [](const Floats& weights) {
    const Scene scene = moved_up(weights);
    const Vec3 corners[] = {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0, 2, 0)};
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT((only_mesh(scene).positions.at(i) - corners[i]).norm(), 1e-6f) << weights[0];
  };
  for (const float scale : {1e-30f, 1e-3f, 0.5f, 1.0f, 3.0f, 1e30f})
    expect_moved({0.5f * scale, 0.25f * scale, 0.25f * scale, 0});
  expect_moved({0, -1, std::nanf(""), 0});  // the first joint
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
