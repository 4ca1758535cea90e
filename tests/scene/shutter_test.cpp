// The states of an open shutter are those that the scene has at these times.

#include "scene/shutter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/gltf.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/moved_triangle.h"

namespace gatelight::scene {
namespace {

const std::string kShutterRoom = GATELIGHT_DATA "/moving-room.glb";
/// Between two keys of all animations, which are 24 in a second.
constexpr double kTime = 17.5 / 24.0, kOpen = 0.04;

TEST(Shutter, HasTheStatesOfItsTimes) {
  const Scene scene = load_gltf(kShutterRoom, {.time = kTime, .shutter = kOpen});
  const ShutterMotion& shutter = scene.shutter;
  ASSERT_TRUE(shutter.is_open && shutter.instances);
  std::size_t transforms = 0, vertices = 0, cameras = 0;
  for (std::size_t key = 0; key < kShutterKeys; ++key) {
    const double place = static_cast<double>(key) / (kShutterKeys - 1) - 0.5;
    const Scene still = load_gltf(kShutterRoom, {.time = kTime + kOpen * place});
    EXPECT_FALSE(still.shutter.is_open);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      const std::vector<Affine>& states = shutter.transforms[i];
      EXPECT_TRUE((states.empty() ? scene.instances[i].transform : states[key]).matrix() ==
                  still.instances[i].transform.matrix());
      transforms += states.empty() ? 0 : 1;
    }
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
      const std::vector<DeformedVertices>& states = shutter.vertices[m];
      EXPECT_TRUE((states.empty() ? scene.meshes[m].positions : states[key].positions) ==
                  still.meshes[m].positions);
      EXPECT_EQ(states.empty() ? scene.meshes[m].normals : states[key].normals, still.meshes[m].normals);
      vertices += states.empty() ? 0 : 1;
    }
    for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
      const std::vector<Camera>& states = shutter.cameras[c];
      EXPECT_TRUE((states.empty() ? scene.cameras[c] : states[key]).transform.matrix() ==
                  still.cameras[c].transform.matrix());
      cameras += states.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(transforms, 0u);
  EXPECT_GT(vertices, 0u);
  EXPECT_GT(cameras, 0u);
}

TEST(Shutter, OnlyWhatMovesHasStates) {
  const Scene scene = load_gltf(kShutterRoom, {.time = kTime, .shutter = kOpen, .animation = "door"});
  std::size_t moving = 0;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    EXPECT_EQ(is_blurred(scene, i), scene.instances[i].moves) << scene.instances[i].name;
    moving += is_blurred(scene, i) ? 1 : 0;
  }
  EXPECT_GT(moving, 0u);
  const Scene after = load_gltf(kShutterRoom, {.time = 1e4, .shutter = kOpen});
  EXPECT_TRUE(after.shutter.is_open);
  EXPECT_FALSE(after.shutter.instances) << "behind the last key nothing moves";
}

TEST(Shutter, MovesLinearlyBetweenItsStates) {
  AnimatedFile file = translated_triangle({0, 1}, {0, 0, 0, 8, 0, 0});
  const Scene scene = file.load({.time = 0.5, .shutter = 0.5, .bake_transforms = false});
  const std::array<Vec3, 3> middle = world_triangle(scene, scene.instances[0], 0);
  for (const float time : {0.0f, 0.1f, 0.5f, 0.77f, 1.0f}) {
    const std::array<Vec3, 3> moved = world_triangle_at(scene, 0, 0, time);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(moved[k].isApprox(middle[k] + Vec3(4.0f * (time - 0.5f), 0, 0), 1e-6f)) << time;
  }
}

TEST(Shutter, LightsTurnAndMove) {
  AnimatedFile file = moving_triangle();
  set_lights(file, {{{"type", "spot"}, {"spot", json::object()}}});
  file.node({{"extensions", light_of_node(0)}});
  file.move(1, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 4, 0, 0})});
  const float half = std::sqrt(0.5f);
  file.move(1, "rotation", {file.seconds({0, 1}), file.quaternions({0, 0, 0, 1, 0, half, 0, half})});
  const Scene scene = file.load({.time = 0.5, .shutter = 1.0});
  const std::vector<LightPlace>& states = scene.shutter.lights.at(0);
  ASSERT_EQ(states.size(), std::size_t{2 * (kShutterKeys - 1) + 1}) << "a quarter turn";
  for (const float time : {0.0f, 0.3f, 1.0f}) {
    const LightPlace place = light_at(states, time);
    EXPECT_TRUE(place.position.isApprox(Vec3(4.0f * time, 0, 0), 1e-5f)) << place.position.transpose();
    const float angle = 0.5f * kPi * time;
    EXPECT_LT((place.direction - Vec3(-std::sin(angle), 0, -std::cos(angle))).norm(), 3e-3f) << time;
    EXPECT_NEAR(place.direction.norm(), 1.0f, 1e-5f);
  }
}

TEST(Shutter, RefusesTimesThatAreNone) {
  for (const double shutter : {-0.1, std::nan(""), HUGE_VAL})
    EXPECT_THROW(load_gltf(kShutterRoom, {.time = 0.0, .shutter = shutter}), BadOption) << shutter;
}

}  // namespace
}  // namespace gatelight::scene
