// Frames: one and ten thousand, joints that collapse, vertices that leave the scene.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "renderer/render.h"
#include "scene/gltf.h"
#include "tests/support/animated_file.h"
#include "tests/support/messages.h"

namespace gatelight::scene {
namespace {

using renderer::Picture;
using renderer::Renderer;
using renderer::RenderOptions;

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

/// A triangle that goes from x = 0 to x = 1 in a second.
AnimatedFile going_triangle() {
  AnimatedFile file = moving_triangle();
  file.move(0, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 1, 0, 0})});
  return file;
}

TEST(FramesAtExtremes, OneAndTenThousand) {
  constexpr int kFrames = 10'000;
  Player player(going_triangle());
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
  json primitive = file.triangle();
  primitive["attributes"]["JOINTS_0"] =
      file.accessor(std::vector<std::uint16_t>(12, 0), kUnsignedShort, "VEC4", 3);
  primitive["attributes"]["WEIGHTS_0"] =
      file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kFloat, "VEC4", 3);
  file.node({{"mesh", file.mesh(primitive)}, {"skin", 0}});
  file.move(joint, "scale",
            {file.seconds({0, 1, 2, 3}), file.vectors({1, 1, 1, 0, 0, 0, 1e-30f, 1, 1, -1, 1, 1})});
  Player player(file);
  for (const double seconds : {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 1.0}) {
    EXPECT_TRUE(all_finite(player.frame(2, seconds))) << seconds;
    for (const Vec3& p : player.scene.meshes.at(0).positions) EXPECT_TRUE(p.allFinite()) << seconds;
  }
}

TEST(FramesAtExtremes, VerticesThatLeaveTheScene) {
  AnimatedFile file = moving_triangle();
  file.move(0, "translation", {file.seconds({0, 1, 2}), file.vectors({0, 0, 0, 9e8f, 0, 0, 1e12f, 0, 0})});
  Player player(file);
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
  AnimatedFile spinning = moving_triangle();
  spinning.move(0, "rotation",
                {spinning.seconds({0, 1, 2}), spinning.quaternions({0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1})});
  Player spun(spinning, 1e6);
  EXPECT_TRUE(all_finite(spun.frame(0, 0.0)));
  AnimatedFile leaving = moving_triangle();
  leaving.move(0, "translation", {leaving.seconds({0, 1}), leaving.vectors({0, 0, 0, 1e12f, 0, 0})});
  EXPECT_TRUE(all_finite(Player(leaving, 1e-4).frame(0, 0.0)));
  Player gone(leaving);
  SceneFile open(leaving.write(gone.folder), {.time = 0.0, .shutter = 0.5});
  tests::expect_refusal<InputError>([&] { open.load(); }, {"1e+09"});
}

}  // namespace
}  // namespace gatelight::scene
