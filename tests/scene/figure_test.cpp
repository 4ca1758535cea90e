// The posed figure of data/, against the bounds that its generator computes by itself.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "scene/gltf.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::scene {
namespace {

const std::string kFigure = GATELIGHT_DATA "/figure.glb";

json json_of_figure() {
  const std::string file = tests::read_file(kFigure);
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 12, sizeof length);
  return json::parse(file.substr(20, length));
}

Box bounds_of(const Scene& scene, const std::string& name) {
  Box bounds;
  for (const Instance& instance : scene.instances) {
    if (instance.name != name) continue;
    for (const Vec3& p : scene.mesh_of(instance).positions) bounds.extend(instance.transform * p);
  }
  return bounds;
}

TEST(Figure, HasTheBoundsOfItsPose) {
  const Scene scene = load_gltf(kFigure);
  EXPECT_TRUE(scene.warnings.empty());
  const json expected = json_of_figure()["asset"]["extras"]["posed_bounds"];
  for (const std::string name : {"body", "face"}) {
    const Box bounds = bounds_of(scene, name);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(bounds.min()[k], expected[name][0][k].get<float>(), 1e-4f) << name << k;
      EXPECT_NEAR(bounds.max()[k], expected[name][1][k].get<float>(), 1e-4f) << name << k;
    }
    if (name == "body") {
      EXPECT_NEAR(bounds.min().y(), 0.0f, 1e-3f) << "it stands on the floor";
    }
  }
}

TEST(Figure, HasAWalkOfEveryJoint) {
  const json root = json_of_figure();
  const json& walk = root["animations"][0];
  std::set<int> turned;
  int splines = 0;
  for (const json& channel : walk["channels"]) {
    const json& sampler = walk["samplers"][channel["sampler"].get<std::size_t>()];
    const json& times = root["accessors"][sampler["input"].get<std::size_t>()];
    EXPECT_EQ(times["min"][0], 0.0);
    EXPECT_EQ(times["max"][0], 1.0);
    if (channel["target"]["path"] == "rotation") turned.insert(channel["target"]["node"].get<int>());
    const bool spline = sampler["interpolation"] == "CUBICSPLINE";
    splines += spline ? 1 : 0;
    const json& values = root["accessors"][sampler["output"].get<std::size_t>()];
    EXPECT_EQ(values["count"].get<int>(), times["count"].get<int>() * (spline ? 3 : 1));
  }
  EXPECT_EQ(splines, 1);
  const json& joints = root["skins"][0]["joints"];
  EXPECT_EQ(turned, std::set<int>(joints.begin(), joints.end()));
}

TEST(Figure, WalksInALoop) {
  const Scene first = load_gltf(kFigure, {.time = 0.0});
  const Scene last = load_gltf(kFigure, {.time = 1.0});
  EXPECT_TRUE(first.warnings.empty());
  ASSERT_EQ(first.animations.size(), 1u);
  EXPECT_EQ(first.animations[0].name, "walk");
  EXPECT_EQ(first.animations[0].seconds, 1.0);
  ASSERT_EQ(first.meshes.size(), last.meshes.size());
  for (std::size_t i = 0; i < first.meshes.size(); ++i) {
    for (std::size_t k = 0; k < first.meshes[i].positions.size(); ++k)
      ASSERT_LT((first.meshes[i].positions[k] - last.meshes[i].positions[k]).norm(), 2e-5f);
  }
  const Scene still = load_gltf(kFigure);
  EXPECT_GT((bounds_of(still, "body").max() - bounds_of(first, "body").max()).norm(), 0.1f)
      << "it waves no more";
}

/// The figure in the pose of a key of its linear samplers, without animations.
GltfBuilder figure_at_key(std::size_t key) {
  const std::string file = tests::read_file(kFigure);
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 12, sizeof length);
  GltfBuilder figure;
  figure.root = json::parse(file.substr(20, length));
  figure.bin.assign(file.begin() + 28 + static_cast<std::ptrdiff_t>(length), file.end());
  const json walk = figure.root["animations"][0];
  figure.root.erase("animations");
  for (const json& channel : walk["channels"]) {
    const json& sampler = walk["samplers"][channel["sampler"].get<std::size_t>()];
    const json& values = figure.root["accessors"][sampler["output"].get<std::size_t>()];
    const bool spline = sampler["interpolation"] == "CUBICSPLINE";
    const std::size_t row = spline ? 3 * (key / 6) + 1 : key;
    const std::size_t width = channel["target"]["path"] == "rotation" ? 4 : 3;
    std::vector<float> value(width);
    const json& view = figure.root["bufferViews"][values["bufferView"].get<std::size_t>()];
    std::memcpy(value.data(),
                figure.bin.data() + view["byteOffset"].get<std::size_t>() + row * width * sizeof(float),
                width * sizeof(float));
    figure.root["nodes"][channel["target"]["node"].get<std::size_t>()]
               [channel["target"]["path"].get<std::string>()] = value;
  }
  return figure;
}

TEST(Figure, HasThePosesOfItsKeys) {
  for (const std::size_t key : {0u, 6u, 18u}) {
    const Scene posed = figure_at_key(key).load();
    const Scene shown = load_gltf(kFigure, {.time = static_cast<double>(key) / 24.0});
    ASSERT_EQ(posed.meshes.size(), shown.meshes.size());
    for (std::size_t i = 0; i < posed.meshes.size(); ++i) {
      for (std::size_t k = 0; k < posed.meshes[i].positions.size(); ++k)
        ASSERT_LT((posed.meshes[i].positions[k] - shown.meshes[i].positions[k]).norm(), 2e-6f) << key;
    }
  }
}

TEST(Figure, WalksOnTheFloor) {
  for (int k = 0; k < 48; ++k) {
    const Box body = bounds_of(load_gltf(kFigure, {.time = k / 48.0}), "body");
    EXPECT_GT(body.min().y(), -0.006f) << "a heel sinks in at " << k;
    EXPECT_LT(body.min().y(), 1e-6f) << "one foot stands at " << k;
  }
}

}  // namespace
}  // namespace gatelight::scene
