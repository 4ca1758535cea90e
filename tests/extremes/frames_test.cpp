// Frames and poses: one and ten thousand, joints that collapse, vertices that leave the scene, weights of any
// sum, targets of nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include "renderer/render.h"
#include "scene/gltf.h"
#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/messages.h"

namespace gatelight::scene {
namespace {

using renderer::Picture;
using renderer::Renderer;
using renderer::RenderOptions;
using Floats = std::vector<float>;

RenderOptions small_frames() {
  RenderOptions options;
  options.width = 8;
  options.height = 6;
  options.spp = 1;
  options.threads = 1;
  options.environment.constant = Color::Ones();
  return options;
}

/// A file that is open, with a renderer of its scene.
struct Player {
  explicit Player(AnimatedFile made, double shutter = 0.0)
      : folder(),
        file(made.write(folder), {.time = 0.0, .shutter = shutter}),
        scene(file.load()),
        renderer(scene, small_frames()) {
    renderer.begin_frames(0.0);
  }

  Picture frame(int number, double seconds) {
    file.show(scene, seconds);
    renderer.scene_moved({});
    return renderer.render_frame(number);
  }

  tests::TemporaryFolder folder;
  SceneFile file;
  Scene scene;
  Renderer renderer;
};

bool all_finite(const Picture& picture) {
  const std::vector<float>& values = picture.layers.front().values;
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

double resident_mebibytes() {
  std::ifstream file("/proc/self/statm");
  double all = 0.0, resident = 0.0;  // pages
  file >> all >> resident;
  return resident * 4096.0 / 0x1p20;
}

TEST(FramesAtExtremes, OneAndTenThousand) {
  constexpr int kFrames = 10'000;
  Player player(translated_triangle({0, 1}, {0, 0, 0, 1, 0, 0}));
  Picture first = player.frame(0, 0.0);
  const double before = resident_mebibytes();
  for (int i = 1; i < kFrames; ++i) ASSERT_TRUE(all_finite(player.frame(i, i / 24.0)));
  EXPECT_LT(resident_mebibytes() - before, 20.0);
  EXPECT_EQ(player.frame(0, 0.0).layers.front().values, first.layers.front().values);
}

TEST(FramesAtExtremes, JointsThatCollapse) {
  AnimatedFile file;
  const int joint = file.node({{"translation", {0, 0, 0}}});
  file.add("skins", {{"joints", {joint}}});
  file.node({{"mesh", file.mesh(triangle_of_joint(file))}, {"skin", 0}});
  file.move(joint, "scale",
            {file.seconds({0, 1, 2, 3}), file.vectors({1, 1, 1, 0, 0, 0, 1e-30f, 1, 1, -1, 1, 1})});
  Player player(file);
  for (const double seconds : {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 1.0}) {
    EXPECT_TRUE(all_finite(player.frame(2, seconds))) << seconds;
    for (const Vec3& p : player.scene.meshes.at(0).positions) EXPECT_TRUE(p.allFinite()) << seconds;
  }
}

TEST(FramesAtExtremes, VerticesThatLeaveTheScene) {
  Player player(translated_triangle({0, 1, 2}, {0, 0, 0, 9e8f, 0, 0, 1e12f, 0, 0}));
  EXPECT_TRUE(all_finite(player.frame(0, 0.0)));
  EXPECT_TRUE(all_finite(player.frame(1, 1.0)));
  tests::expect_refusal<InputError>([&] { player.file.show(player.scene, 2.0); }, {"1e+09"});
  EXPECT_TRUE(all_finite(player.frame(3, 0.5))) << "the frames after it";
}

TEST(FramesAtExtremes, MotionWhileAShutterIsOpen) {
  AnimatedFile turned = moving_triangle();
  const auto seconds = turned.seconds({0, 1, 2, 3});
  turned.move(0, "scale", {seconds, turned.vectors({1, 1, 1, -1, 1, 1, 0, 0, 0, 1, 1e-30f, 1})});
  Player inverted(turned, 1.0);
  for (const double time : {0.0, 0.5, 1.0, 1.5, 2.5, 1e9})
    EXPECT_TRUE(all_finite(inverted.frame(0, time))) << time;
  Player spun(rotated_triangle({0, 1, 2}, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}), 1e6);
  EXPECT_TRUE(all_finite(spun.frame(0, 0.0)));
  AnimatedFile leaving = translated_triangle({0, 1}, {0, 0, 0, 1e12f, 0, 0});
  EXPECT_TRUE(all_finite(Player(leaving, 1e-4).frame(0, 0.0)));
  Player gone(leaving);
  SceneFile open(leaving.write(gone.folder), {.time = 0.0, .shutter = 0.5});
  tests::expect_refusal<InputError>([&] { open.load(); }, {"1e+09"});
}

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
