// The states of an open shutter are those that the scene has at these times; what turns, jumps and bends
// while it is open, against its place at the clock's time.

#include "scene/shutter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/gltf.h"
#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"

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

/// The shutter is open from 0 to 1 s.
const LoadOptions kOneSecond{.time = 0.5, .shutter = 1.0, .bake_transforms = false};

/// Keys of a rotation about z, every quarter turn from 0 to 1 s.
AnimatedFile::Keys turns(AnimatedFile& file, int count) {
  AnimatedFile::Floats seconds, quaternions;
  for (int key = 0; key <= 4 * count; ++key) {
    seconds.push_back(static_cast<float>(key) / static_cast<float>(4 * count));
    const float half = 0.25f * kPi * static_cast<float>(key);
    quaternions.insert(quaternions.end(), {0, 0, std::sin(half), std::cos(half)});
  }
  return {file.seconds(seconds), file.quaternions(quaternions)};
}

/// Where the clock's time shows a point of the instance's mesh.
Vec3 seen_at(const Scene& scene, std::size_t instance, float clock, const Vec3& point = Vec3::Zero()) {
  const std::vector<Affine>& states = scene.shutter.transforms.at(instance);
  if (states.empty()) return scene.instances[instance].transform * point;
  return transform_at(states, time_by_clock(scene.shutter.clock, clock)) * point;
}

/// The largest distance from the place of each of many times, taken by themselves.
float worst_place(AnimatedFile& file, const Scene& scene) {
  const TemporaryFolder folder;
  SceneFile still(file.write(folder), {.time = 0.0, .bake_transforms = false});
  Scene now = still.load();
  float worst = 0.0f;
  for (int k = 0; k < 97; ++k) {
    const double clock = (k + 0.37) / 97.0;
    still.show(now, clock);
    for (std::size_t i = 0; i < now.instances.size(); ++i) {
      const Vec3 place = now.instances[i].transform.translation();
      worst = std::max(worst, (seen_at(scene, i, static_cast<float>(clock)) - place).norm());
    }
  }
  return worst;
}

TEST(ShutterTimes, TurnsAreArcs) {
  for (const auto& [count, sagitta] : {std::pair{1, 1.3e-3f}, std::pair{2, 1.3e-3f}, std::pair{4, 5e-3f}}) {
    AnimatedFile file = moving_triangle();
    file.move(0, "rotation", turns(file, count));
    file.node({{"mesh", 0}});
    file.move(1, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 1, 0, 0})});
    const Scene scene = file.load(kOneSecond);
    for (int k = 0; k <= 1000; ++k) {
      const float time = static_cast<float>(k) / 1000.0f;
      const Vec3 rim = transform_at(scene.shutter.transforms.at(0), time) * Vec3(1, 0, 0);
      EXPECT_LE(rim.norm(), 1.0f + 1e-6f);
      EXPECT_GE(rim.norm(), 1.0f - sagitta) << count << " turns, at " << time;
      const float angle = 2.0f * kPi * static_cast<float>(count) * time;
      EXPECT_LT((rim - Vec3(std::cos(angle), std::sin(angle), 0)).norm(), 2.0f * sagitta) << time;
    }
    EXPECT_EQ(scene.shutter.transforms.at(1).size(), std::size_t{kShutterKeys}) << "it does not turn";
    EXPECT_TRUE(scene.shutter.clock.empty());
    EXPECT_TRUE(scene.warnings.empty());
  }
  AnimatedFile file = moving_triangle();
  file.move(0, "rotation", turns(file, 9));
  const Scene fast = file.load(kOneSecond);
  EXPECT_EQ(fast.shutter.transforms.at(0).size(), std::size_t{kMaxShutterIntervals} + 1);
  tests::expect_messages(fast.warnings, {{"rotation", "25 degrees"}});
}

TEST(ShutterTimes, TurnsBelongToAllThatIsBelow) {
  AnimatedFile file;
  set_lights(file, {{{"type", "point"}}});
  const int child = file.add("nodes", {{"mesh", file.mesh(file.triangle())}, {"translation", {2, 0, 0}}});
  const int eye = file.add("nodes", {{"camera", camera(file)}, {"translation", {0, 2, 0}}});
  const int lamp = file.add("nodes", {{"extensions", light_of_node(0)}, {"translation", {2, 0, 0}}});
  const int joint = file.add("nodes", {{"translation", {1, 0, 0}}});
  const int hub = file.node({{"children", {child, eye, lamp, joint}}});
  file.add("skins", {{"joints", {joint}}});
  file.node({{"mesh", file.mesh(triangle_of_joint(file))}, {"skin", 0}});
  file.move(hub, "rotation", turns(file, 2));
  const Scene scene = file.load(kOneSecond);
  for (const float time : {0.013f, 0.31f, 0.5f, 0.77f}) {
    EXPECT_NEAR(transform_at(scene.shutter.transforms.at(0), time).translation().norm(), 2.0f, 3e-3f);
    EXPECT_NEAR(camera_at(scene.shutter.cameras.at(0), time).transform.translation().norm(), 2.0f, 3e-3f);
    EXPECT_NEAR(light_at(scene.shutter.lights.at(0), time).position.norm(), 2.0f, 3e-3f);
    // The second corner of the skinned triangle is one metre beyond the joint.
    EXPECT_NEAR(world_triangle_at(scene, 1, 0, time)[1].norm(), 2.0f, 3e-3f);
  }
}

TEST(ShutterTimes, AJumpTakesNoTime) {
  for (const float key : {0.03f, 0.25f, 0.5f, 0.501f, 0.8f, 1.0f}) {
    AnimatedFile file = translated_triangle({0, key}, {0, 0, 0, 8, 0, 0}, "STEP");
    const Scene scene = file.load(kOneSecond);
    for (int k = 0; k < 1000; ++k) {
      const float clock = (static_cast<float>(k) + 0.5f) / 1000.0f;
      EXPECT_NEAR(seen_at(scene, 0, clock).x(), clock < key ? 0.0f : 8.0f, 1e-4f) << key << ", " << clock;
    }
    EXPECT_EQ(time_by_clock(scene.shutter.clock, 0.5f), 0.5f);
    EXPECT_EQ(seen_at(scene, 0, 0.5f).x(), scene.instances[0].transform.translation().x());
  }
}

TEST(ShutterTimes, CornersOfSeveralObjectsAreKept) {
  AnimatedFile file = moving_triangle();
  for (int i = 0; i < 3; ++i) file.node({{"mesh", 0}});
  file.move(0, "translation",
            {file.seconds({0, 0.33f, 1}), file.vectors({0, 0, 0, 0, 3, 0, 0, -1, 0})});  // bounces
  file.move(1, "translation", {file.seconds({0.1f, 0.45f, 0.46f}), file.vectors({0, 0, 0, 1, 0, 0, 1, 2, 0})},
            "STEP");
  file.move(2, "translation",
            {file.seconds({0.62f, 0.7f}), file.vectors({0, 0, 0, 1, 0, 0})});  // starts, stops
  file.move(3, "translation",
            {file.seconds({0, 0.9f, 0.9f, 1}), file.vectors({0, 0, 0, 1, 0, 0, 5, 0, 0, 6, 0, 0})});  // cuts
  Scene scene = file.load(kOneSecond);
  EXPECT_LT(worst_place(file, scene), 1e-4f);
  EXPECT_NEAR(seen_at(scene, 0, 0.33f).y(), 3.0f, 1e-4f) << "the turning point";
}

TEST(ShutterTimes, SplinesBendOnlyWhereTheirTangentsDo) {
  const auto with_tangents = [](float in, float out) {
    AnimatedFile file = moving_triangle();
    const AnimatedFile::Floats rows{0, 0,   0, 0, 0, 0, 1, 0, 0, in, 0, 0, 1, 0,
                                    0, out, 0, 0, 0, 0, 0, 2, 0, 0,  0, 0, 0};
    file.move(0, "translation", {file.seconds({0, 0.37f, 1}), file.vectors(rows)}, "CUBICSPLINE");
    return file;
  };
  EXPECT_TRUE(with_tangents(1, 1).load(kOneSecond).shutter.clock.empty());
  EXPECT_TRUE(with_tangents(0, 0).load(kOneSecond).shutter.clock.empty()) << "eased in and out";
  AnimatedFile bent = with_tangents(6, -6);
  const Scene scene = bent.load(kOneSecond);
  EXPECT_FALSE(scene.shutter.clock.empty());
  EXPECT_NEAR(seen_at(scene, 0, 0.37f).x(), 1.0f, 1e-4f);
}

TEST(ShutterTimes, StraightMotionHasNoCorners) {
  AnimatedFile file = translated_triangle({-1, 0.1f, 0.37f, 2}, {-1, 0, 0, 0.1f, 0, 0, 0.37f, 0, 0, 2, 0, 0});
  file.move(0, "rotation", turns(file, 1));
  file.move(0, "scale", {file.seconds({0, 0.37f}), file.vectors({1, 1, 1, 1, 1, 1})}, "STEP");
  const Scene scene = file.load(kOneSecond);
  EXPECT_TRUE(scene.shutter.clock.empty());
}

TEST(ShutterTimes, MorphsAndVisibilityJump) {
  AnimatedFile file;
  json morphed = file.triangle();
  morphed["targets"] = {{{"POSITION", file.vectors({0, 0, 4, 0, 0, 4, 0, 0, 4})}}};
  file.node({{"mesh", file.mesh(morphed)}});
  file.move(0, "weights", {file.seconds({0, 0.3f}), file.scalars({0, 1})}, "STEP");
  file.node(
      {{"mesh", file.mesh(file.triangle())}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
  file.move(
      "/nodes/1/extensions/KHR_node_visibility/visible",
      {file.seconds({0, 0.2f}), file.accessor(std::vector<std::uint8_t>{1, 0}, kUnsignedByte, "SCALAR", 2)},
      "STEP");
  file.node({{"mesh", 1}});
  file.move(2, "scale", {file.seconds({0, 0.6f}), file.vectors({0, 0, 0, 2, 2, 2})}, "STEP");
  const Scene scene = file.load(kOneSecond);
  ASSERT_EQ(scene.instances.size(), 3u);
  const auto area = [&](std::size_t instance, float time) {
    const std::array<Vec3, 3> p = world_triangle_at(scene, instance, 0, time);
    return 0.5f * (p[1] - p[0]).cross(p[2] - p[0]).norm();
  };
  for (const float clock : {0.1f, 0.19f, 0.21f, 0.29f, 0.31f, 0.5f, 0.59f, 0.61f, 0.9f}) {
    const float time = time_by_clock(scene.shutter.clock, clock);
    EXPECT_NEAR(world_triangle_at(scene, 0, 0, time)[0].z(), clock < 0.3f ? 0.0f : 4.0f, 1e-4f) << clock;
    EXPECT_NEAR(area(1, time), clock < 0.2f ? 0.5f : 0.0f, 1e-4f) << clock;
    EXPECT_NEAR(area(2, time), clock < 0.6f ? 0.0f : 2.0f, 1e-4f) << clock;
  }
  EXPECT_FALSE(scene.instances[1].hidden) << "it was there in a part of the shutter";
  EXPECT_TRUE(file.load({.time = 0.5, .shutter = 0.1, .bake_transforms = false}).instances[1].hidden);
}

TEST(ShutterTimes, TooManyKeysAreBlurredEvenly) {
  AnimatedFile file = moving_triangle();
  AnimatedFile::Floats seconds, places;
  for (int key = 0; key < 400; ++key) {
    seconds.push_back(static_cast<float>(key) / 400.0f);
    places.insert(places.end(), {static_cast<float>(key % 2), 0, 0});
  }
  file.move(0, "translation", {file.seconds(seconds), file.vectors(places)}, "STEP");
  const Scene scene = file.load(kOneSecond);
  EXPECT_EQ(scene.shutter.transforms.at(0).size(), std::size_t{kMaxShutterIntervals} + 1);
  EXPECT_TRUE(scene.shutter.clock.empty());
  tests::expect_messages(scene.warnings, {{"399 keys", "129"}});
}

}  // namespace
}  // namespace gatelight::scene
