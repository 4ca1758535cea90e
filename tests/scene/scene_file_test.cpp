// A file that stays open shows each time as a file that is opened for it; the posed figure of data/ against
// the bounds that its generator computes by itself.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/gltf.h"
#include "tests/support/animated_file.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::scene {
namespace {

const std::string kFigure = GATELIGHT_DATA "/figure.glb";
const std::string kMovingRoom = GATELIGHT_DATA "/moving-room.glb";

void expect_same_scene(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.instances.size(), b.instances.size());
  for (std::size_t i = 0; i < a.instances.size(); ++i) {
    EXPECT_TRUE(a.instances[i].transform.matrix() == b.instances[i].transform.matrix()) << i;
    EXPECT_EQ(a.instances[i].hidden, b.instances[i].hidden) << i;
    EXPECT_EQ(a.instances[i].swaps_handedness, b.instances[i].swaps_handedness) << i;
    EXPECT_EQ(a.instances[i].mesh, b.instances[i].mesh) << i;
  }
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    EXPECT_TRUE(a.meshes[m].positions == b.meshes[m].positions) << m;
    EXPECT_EQ(a.meshes[m].normals, b.meshes[m].normals) << m;
    EXPECT_EQ(a.meshes[m].triangles, b.meshes[m].triangles) << m;
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t m = 0; m < a.materials.size(); ++m) {
    EXPECT_TRUE((a.materials[m].emission == b.materials[m].emission).all()) << m;
    EXPECT_TRUE((a.materials[m].base_color == b.materials[m].base_color).all()) << m;
  }
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].position, b.lights[i].position) << i;
    EXPECT_TRUE((a.lights[i].intensity == b.lights[i].intensity).all()) << i;
  }
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i)
    EXPECT_TRUE(a.cameras[i].transform.matrix() == b.cameras[i].transform.matrix()) << i;
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.bounds.min(), b.bounds.min());
  EXPECT_EQ(a.bounds.max(), b.bounds.max());
}

TEST(SceneFile, ShowsTimesInAnyOrder) {
  AnimatedFile morphs = morphing_triangle();
  morphs.move(0, "weights", {morphs.seconds({0, 1}), morphs.scalars({0, 1, 1, 0.5f})});
  const TemporaryFolder folder;
  for (const std::string& path : {kFigure, kMovingRoom, morphs.write(folder).string()}) {
    SceneFile file(path, {.time = 0.0});
    Scene scene = file.load();
    for (const double seconds : {0.5, 1.25, 0.0, -3.0, 0.5, 1e6}) {
      SCOPED_TRACE(seconds);
      file.show(scene, seconds);
      expect_same_scene(scene, load_gltf(path, {.time = seconds}));
    }
  }
}

TEST(SceneFile, ClaimsItsMemoryOnce) {
  AnimatedFile file = moving_triangle({{"translation", {1e6, 0, 0}}});
  const int places = zeros(file, kFloat, "VEC3", 300'000);
  file.root["nodes"][0]["extensions"] = instancing({{"TRANSLATION", places}});
  file.move(0, "translation", {file.seconds({0, 1}), file.vectors({1e6f, 0, 0, 1e6f, 1, 0})});
  const TemporaryFolder folder;
  SceneFile open(file.write(folder), {.time = 0.0});
  Scene scene = open.load();
  for (int k = 1; k < 10; ++k) EXPECT_NO_THROW(open.show(scene, 0.1 * k));
  EXPECT_EQ(scene.instances.size(), 300'000u);
}

TEST(SceneFile, KnowsWhatMoves) {
  const SceneMotion figure = load_gltf(kFigure, {.time = 0.0}).motion;
  EXPECT_TRUE(figure.instances);
  EXPECT_FALSE(figure.lights || figure.materials || figure.image_light);
  EXPECT_FALSE(load_gltf(kFigure).motion.any()) << "the pose of its nodes";
  EXPECT_FALSE(load_gltf(kMovingRoom, {.time = 0.0, .animation = "camera"}).motion.any());
  const SceneMotion dark = load_gltf(kMovingRoom, {.time = 0.0, .animation = "lamp-off"}).motion;
  EXPECT_TRUE(dark.materials);
  EXPECT_FALSE(dark.instances);
}

TEST(SceneFile, OnlyWhatMovesStaysAnInstance) {
  const Scene scene = load_gltf(kMovingRoom, {.time = 0.0, .animation = "door"});
  int moving = 0;
  for (const Instance& instance : scene.instances) {
    EXPECT_NE(instance.moves, instance.baked) << instance.name;
    moving += instance.moves ? 1 : 0;
  }
  EXPECT_GT(moving, 0);
  EXPECT_LT(moving, static_cast<int>(scene.instances.size()));
}

TEST(SceneFile, LightsThatAreAdjustedStayAdjusted) {
  AnimatedFile file;
  file.node({{"mesh", file.mesh(file.triangle())}});
  set_lights(file, {{{"type", "point"}, {"name", "lamp"}}});
  file.node({{"extensions", light_of_node(0)}});
  file.move(1, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 4, 0, 0})});
  tests::TemporaryFolder folder;
  SceneFile open(file.write(folder), {.time = 0.0, .lights = {{"lamp", Color(3, 2, 1)}}});
  Scene scene = open.load();
  for (const double seconds : {0.25, 0.5, 1.0}) {
    open.show(scene, seconds);
    EXPECT_EQ(scene.lights.at(0).position.x(), 4.0f * static_cast<float>(seconds));
    EXPECT_TRUE((scene.lights.at(0).intensity == Color(3, 2, 1)).all());
  }
}

TEST(SceneFile, WhatIsScaledToNothingIsHiddenForThatTime) {
  AnimatedFile file = moving_triangle();
  file.move(0, "scale", {file.seconds({0, 1, 2}), file.vectors({1, 1, 1, 0, 0, 0, 2, 2, 2})}, "STEP");
  tests::TemporaryFolder folder;
  SceneFile open(file.write(folder), {.time = 1.0});
  Scene scene = open.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(scene.instances[0].hidden);
  open.show(scene, 2.0);
  EXPECT_FALSE(scene.instances[0].hidden);
  EXPECT_EQ(scene.instances[0].transform.linear()(0, 0), 2.0f);
}

TEST(SceneFile, AFlatInstanceGetsAThickness) {
  AnimatedFile file = moving_triangle();
  file.move(0, "scale", {file.seconds({0, 1}), file.vectors({1, 1, 1, 3, 2, 0})});
  const Affine flat = file.transform_at(1.0);
  const Eigen::Matrix3f m = flat.linear();
  EXPECT_GT(std::abs(m.determinant()), 0.0f);
  EXPECT_NEAR(m(0, 0), 3.0f, 1e-5f);
  EXPECT_NEAR(m(1, 1), 2.0f, 1e-5f);
  EXPECT_NEAR(m(2, 2), 3e-5f, 1e-6f);
}

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

TEST(Figure, WalksOnTheFloor) {
  for (int k = 0; k < 48; ++k) {
    const Box body = bounds_of(load_gltf(kFigure, {.time = k / 48.0}), "body");
    EXPECT_GT(body.min().y(), -0.006f) << "a heel sinks in at " << k;
    EXPECT_LT(body.min().y(), 1e-6f) << "one foot stands at " << k;
  }
}

}  // namespace
}  // namespace gatelight::scene
