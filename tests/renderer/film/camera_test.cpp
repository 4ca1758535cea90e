#include "renderer/film/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"
#include "renderer/film/camera_choice.h"
#include "tests/support/messages.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using tests::expect_parts;
using tests::expect_refused_parts;

scene::Scene scene_with_cameras() {
  scene::Scene s;
  s.path = "test.glb";
  scene::Camera a;
  a.name = "front";
  scene::Camera b;
  b.name = "top";
  b.vertical_fov = 1.2f;
  s.cameras = {a, b};
  return s;
}

CameraOptions named(const std::string& name) {
  CameraOptions options;
  options.name = name;
  return options;
}

TEST(Camera, ConeIsOnePixelWide) {
  scene::Camera c;
  const Camera camera(c, 100, 80);
  const CameraRay a = camera.ray(50, 40);
  const CameraRay b = camera.ray(50, 41);
  EXPECT_NEAR((a.ray.direction - b.ray.direction).norm(), a.cone.spread, 0.01f * a.cone.spread);
}

TEST(Camera, IsChosenByNameThenByIndex) {
  const scene::Scene s = scene_with_cameras();
  EXPECT_EQ(choose_camera(s, {}, 1.0f).name, "front");
  EXPECT_EQ(choose_camera(s, named("top"), 1.0f).name, "top");
  EXPECT_EQ(choose_camera(s, named("1"), 1.0f).name, "top");
  expect_refused_parts<BadOption>([&] { choose_camera(s, named("side"), 1.0f); },
                                  {"camera", "side", "test.glb", "front"});
}

TEST(Camera, LookAtPutsTheTargetInTheCentreAndUpAbove) {
  CameraOptions options;
  options.look_at = LookAt{{1, 2, 3}, {4, 0, -5}, {0, 1, 0}};
  const Camera camera(choose_camera({}, options, 1.0f), 64, 64);
  EXPECT_TRUE(
      camera.ray(32, 32).ray.direction.isApprox((Vec3(4, 0, -5) - Vec3(1, 2, 3)).normalized(), 1e-5f));
  EXPECT_GT(camera.ray(32, 0).ray.direction.y(), camera.ray(32, 64).ray.direction.y());
  options.look_at = LookAt{{0, 5, 0}, {0, 0, 0}, {0, 1, 0}};  // straight down
  EXPECT_TRUE(Camera(choose_camera({}, options, 1.0f), 8, 8).ray(4, 4).ray.direction.allFinite());
  options.look_at = LookAt{{1, 1, 1}, {1, 1, 1}, {0, 1, 0}};
  EXPECT_THROW(choose_camera({}, options, 1.0f), BadOption);
}

TEST(Camera, AutoFramingFillsThePictureWithTheWholeSceneAtAnyScaleAndAspect) {
  for (const float scale : {1e-3f, 1.0f, 1e6f}) {
    for (const float aspect : {0.4f, 1.0f, 2.5f}) {
      for (const Vec3& size : {Vec3(4, 1, 2), Vec3(1, 8, 1), Vec3(3, 3, 3), Vec3(2, 0.02f, 2)}) {
        testing::SceneBuilder builder;
        const Vec3 low = Vec3(-1, 0, 2) * scale, high = low + size * scale;
        builder.box(builder.material({}), low, high);
        const scene::Scene& s = builder.scene();
        const scene::Camera c = choose_camera(s, {}, aspect);
        const Affine to_camera(c.transform.inverse());
        const float top = std::tan(0.5f * c.vertical_fov);
        Box picture;  // in units of half the picture's height
        for (int i = 0; i < 8; ++i) {
          const Vec3 p = to_camera * s.bounds.corner(static_cast<Box::CornerType>(i));
          ASSERT_LT(p.z(), 0.0f);
          picture.extend(Vec3(p.x(), p.y(), 0.0f) / (-p.z() * top));
        }
        EXPECT_LE(picture.max().y(), 1.0f);
        EXPECT_GE(picture.min().y(), -1.0f);
        EXPECT_LE(picture.max().x(), aspect);
        EXPECT_GE(picture.min().x(), -aspect);
        const float shorter = 2.0f * std::min(1.0f, aspect);
        EXPECT_GE(picture.sizes().maxCoeff(), 2.0f / 3.0f * shorter);
        EXPECT_LT(std::abs(picture.center().x()), 0.01f * aspect);
        EXPECT_LT(std::abs(picture.center().y()), 0.01f);
      }
    }
  }
}

TEST(Camera, AutoFramingFitsWhatStandsOnWideGround) {
  testing::SceneBuilder builder;
  const int grey = builder.material({});
  builder.box(grey, Vec3(-1000, -0.1f, -1000), Vec3(1000, 0, 1000));
  for (int k = 0; k < 5; ++k)
    builder.sphere(grey, Vec3(3.0f * static_cast<float>(k) - 6, 1, 0), 1, 16, false);
  const auto distance = [&] {
    return (choose_camera(builder.scene(), {}, 1.5f).transform.translation() - Vec3(0, 1, 0)).norm();
  };
  EXPECT_LT(distance(), 60.0f);
  EXPECT_GT(distance(), 12.0f);
  builder.scene().meshes.resize(1);
  builder.scene().instances.resize(1);
  EXPECT_GT(distance(), 1000.0f) << "the ground alone";
}

TEST(Camera, AutoFramingLooksAtTheFront) {
  testing::SceneBuilder builder;
  builder.box(builder.material({}), Vec3(-1, -1, -1), Vec3(1, 1, 1));
  for (const float front : {1.0f, -1.0f}) {
    builder.scene().front = front;
    EXPECT_GT(choose_camera(builder.scene(), {}, 1.0f).transform.translation().z() * front, 1.0f);
  }
}

TEST(Camera, AutoFramingOfNothingAndOfAPointIsAView) {
  EXPECT_TRUE(choose_camera({}, {}, 1.0f).transform.matrix().allFinite());
  testing::SceneBuilder builder;
  builder.mesh(builder.material({}), {Vec3(5, 5, 5), Vec3(5, 5, 5), Vec3(5, 5, 5)}, {{0, 1, 2}});
  const scene::Camera c = choose_camera(builder.scene(), {}, 1.0f);
  EXPECT_GT((c.transform.translation() - Vec3(5, 5, 5)).norm(), 0.0f);
}

TEST(Camera, TargetsAndUpsOfAnyLengthAreDirections) {
  CameraOptions near;
  near.look_at = LookAt{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}};
  const Affine expected = choose_camera({}, near, 1.0f).transform;
  for (const float length : {1e-30f, 1e30f, 3e38f}) {
    CameraOptions options;
    options.look_at = LookAt{{0, 0, 1}, {0, 0, -length}, {0, length, 0}};
    EXPECT_TRUE(choose_camera({}, options, 1.0f).transform.isApprox(expected, 1e-6f)) << length;
  }
}

TEST(Camera, BeyondWhatRaysCanReachItIsRefusedByName) {
  const auto refusal = [](const scene::Scene& s, const CameraOptions& options, float aspect) {
    return tests::refused_parts<BadOption>([&] { choose_camera(s, options, aspect); });
  };
  CameraOptions by_hand;
  by_hand.look_at = LookAt{{1e12f, 0, 0}, {0, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(refusal({}, by_hand, 1.0f).option, "");
  by_hand.look_at->eye.x() = 1e20f;
  expect_parts(refusal({}, by_hand, 1.0f), {"eye", "", "1e+20", "1e+12"});
  scene::Scene s = scene_with_cameras();
  s.cameras[0].transform.translation().z() = -2e12f;
  expect_parts(refusal(s, {}, 1.0f), {"camera", "", "'front' of test.glb is at (0, 0, -2e+12)"});
  s = scene_with_cameras();
  s.cameras[0].orthographic = true;
  s.cameras[0].half_height = 1e11f;
  EXPECT_EQ(refusal(s, {}, 1.0f).option, "");
  expect_parts(refusal(s, {}, 100.0f), {"camera", "", "1e+13"});
}

}  // namespace
}  // namespace gatelight::renderer
