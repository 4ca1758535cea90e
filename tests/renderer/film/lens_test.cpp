// Lenses, projections, and the matrices of a picture's view.

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"
#include "renderer/film/camera.h"
#include "renderer/film/camera_choice.h"
#include "tests/support/messages.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {
using tests::expect_refused_parts;

CameraOptions from_the_front(float distance) {
  CameraOptions options;
  options.look_at = LookAt{{0, 0, distance}, {0, 0, 0}, {0, 1, 0}};
  return options;
}

/// Points of a lens in a grid.
template <class Function>
void each_lens_point(Function function) {
  constexpr int kGrid = 40;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j)
      function(Vec2((static_cast<float>(i) + 0.5f) / kGrid, (static_cast<float>(j) + 0.5f) / kGrid));
  }
}

TEST(Lens, AllRaysOfAPixelMeetInTheFocusPlane) {
  View view;
  view.lens_radius = 0.2f;
  view.focus_distance = 3.0f;
  const Camera camera(view, 200, 100);
  const CameraRay middle = camera.ray(30, 80);
  const Vec3 sharp = middle.ray.origin + middle.ray.direction * (3.0f / -middle.ray.direction.z());
  float farthest = 0.0f;
  each_lens_point([&](const Vec2& u) {
    const Ray ray = camera.ray(30, 80, u).ray;
    EXPECT_NEAR(ray.origin.z(), 0.0f, 1e-6f);
    EXPECT_NEAR(ray.direction.norm(), 1.0f, 1e-6f);
    EXPECT_TRUE((ray.origin + ray.direction * (3.0f / -ray.direction.z())).isApprox(sharp, 1e-5f));
    farthest = std::max(farthest, ray.origin.norm());
  });
  EXPECT_LE(farthest, 0.2f);
  EXPECT_GT(farthest, 0.19f);
}

TEST(Lens, IsSampledEvenly) {
  for (const int blades : {0, 3, 6}) {
    View view;
    view.lens_radius = 1.0f;
    view.focus_distance = 1.0f;
    view.blades = blades;
    const Camera camera(view, 8, 8);
    double squares = 0.0, count = 0.0;
    Vec3 sum = Vec3::Zero();
    each_lens_point([&](const Vec2& u) {
      const Vec3 p = camera.ray(4, 4, u).ray.origin;
      squares += static_cast<double>(p.squaredNorm());
      sum += p;
      count += 1.0;
    });
    // Second moments of the disk and of regular polygons about the middle.
    const double angle = 2.0 * M_PI / std::max(blades, 1);
    const double moment = blades == 0 ? 0.5 : (2.0 + std::cos(angle)) / 6.0;
    EXPECT_NEAR(squares / count, moment, 0.01 * moment) << blades;
    EXPECT_LT(sum.norm() / count, 1e-2) << blades;
  }
}

TEST(Lens, AnFStopIsTheFocalLengthOverTheDiameter) {
  CameraOptions options = from_the_front(5.0f);
  options.focal_mm = 50.0f;
  options.lens.f_stop = 2.0f;
  for (const float aspect : {0.5f, 1.0f, 2.0f}) {
    const View view = choose_camera({}, options, aspect);
    EXPECT_NEAR(view.lens_radius, 0.0125f, 1e-6f) << aspect;
    // 36 mm across the wider side.
    const float wider = std::tan(0.5f * view.vertical_fov) * std::max(1.0f, aspect);
    EXPECT_NEAR(wider, 18.0f / 50.0f, 1e-5f) << aspect;
  }
  options.lens = {.aperture = 0.03f, .focus = "2.5", .blades = 5};
  const View view = choose_camera({}, options, 1.0f);
  EXPECT_FLOAT_EQ(view.lens_radius, 0.015f);
  EXPECT_FLOAT_EQ(view.focus_distance, 2.5f);
  EXPECT_EQ(view.blades, 5);
}

TEST(Lens, FocusesOnAnObjectByItsName) {
  testing::SceneBuilder builder;
  builder.box(builder.material({}), Vec3(-1, -1, -2), Vec3(1, 1, 0));
  scene::Scene s = builder.scene();
  s.instances[0].name = "vase";
  CameraOptions options = from_the_front(4.0f);
  options.lens = {.aperture = 0.1f, .focus = "vase"};
  EXPECT_FLOAT_EQ(choose_camera(s, options, 1.0f).focus_distance, 5.0f);
  options.lens.focus = "cup";
  expect_refused_parts<BadOption>([&] { choose_camera(s, options, 1.0f); }, {"focus", "cup", "built.glb"});
  for (const char* distance : {"-1", "0", "inf", "nan", "1e20"}) {
    options.lens.focus = distance;
    expect_refused_parts<BadOption>([&] { choose_camera(s, options, 1.0f); }, {"focus", distance});
  }
  options.lens.focus = "vase";
  options.look_at = LookAt{{0, 0, 4}, {0, 0, 8}, {0, 1, 0}};
  expect_refused_parts<BadOption>([&] { choose_camera(s, options, 1.0f); }, {"focus", "vase", "behind"});
}

TEST(Projection, APanoramaShowsAllDirections) {
  View view;
  view.panorama = true;
  const Camera camera(view, 400, 200);
  EXPECT_TRUE(camera.ray(200, 100).ray.direction.isApprox(Vec3(0, 0, -1), 1e-5f));
  EXPECT_TRUE(camera.ray(300, 100).ray.direction.isApprox(Vec3(1, 0, 0), 1e-5f));
  EXPECT_TRUE(camera.ray(0, 100).ray.direction.isApprox(Vec3(0, 0, 1), 1e-5f));
  EXPECT_TRUE(camera.ray(77, 0).ray.direction.isApprox(Vec3(0, 1, 0), 1e-5f));
  EXPECT_TRUE(camera.ray(77, 200).ray.direction.isApprox(Vec3(0, -1, 0), 1e-5f));
  EXPECT_FALSE(camera.matrices(Vec3::Zero()));
}

TEST(Projection, AnOrthographicViewShowsTheTargetAsLargeAsThePerspective) {
  CameraOptions options = from_the_front(4.0f);
  options.fov_degrees = 60.0f;
  options.projection = Projection::orthographic;
  const View view = choose_camera({}, options, 1.0f);
  EXPECT_TRUE(view.orthographic);
  EXPECT_NEAR(view.half_height, 4.0f * std::tan(kPi / 6.0f), 1e-4f);
  options.view_height = 3.0f;
  EXPECT_FLOAT_EQ(choose_camera({}, options, 1.0f).half_height, 1.5f);
  options.projection = Projection::camera;
  expect_refused_parts<BadOption>([&] { choose_camera({}, options, 1.0f); },
                                  {"view-height", "", "orthographic"});
  options.view_height.reset();
  options.projection = Projection::panorama;
  expect_refused_parts<BadOption>([&] { choose_camera({}, options, 1.0f); }, {"fov", "", "panorama"});
  options.fov_degrees.reset();
  options.lens.aperture = 0.1f;
  expect_refused_parts<BadOption>([&] { choose_camera({}, options, 1.0f); }, {"aperture", "", "no lens"});
}

/// A point of the scene on a pixel's ray must be at that pixel again by worldToNDC.
TEST(ViewMatrices, TakePointsToTheirPixels) {
  const Vec3 origin(10, 20, 30);  // of the scene in the file
  for (const bool orthographic : {false, true}) {
    CameraOptions options;
    options.look_at = LookAt{{3, 2, 1}, {-1, 0.5f, -4}, {0.2f, 1, 0}};
    if (orthographic) options.projection = Projection::orthographic;
    const Camera camera(choose_camera({}, options, 1.6f), 160, 100);
    const std::optional<ViewMatrices> matrices = camera.matrices(origin);
    ASSERT_TRUE(matrices);
    const Eigen::Map<const Eigen::Matrix4f> to_camera(matrices->world_to_camera.data());
    const Eigen::Map<const Eigen::Matrix4f> to_ndc(matrices->world_to_ndc.data());
    for (const Vec2& pixel : {Vec2(0, 0), Vec2(160, 100), Vec2(33, 80)}) {
      const Ray ray = camera.ray(pixel.x(), pixel.y()).ray;
      const Vec3 point = ray.origin + 7.0f * ray.direction + origin;
      const Vec4 homogeneous(point.x(), point.y(), point.z(), 1.0f);
      const Vec4 at = to_ndc * homogeneous;
      EXPECT_NEAR(at.x() / at.w(), pixel.x() / 160.0f, 2e-5f);
      EXPECT_NEAR(at.y() / at.w(), pixel.y() / 100.0f, 2e-5f);
      EXPECT_GT((to_camera * homogeneous).z(), 0.0f) << "z points into the picture";
    }
  }
}

TEST(CameraNames, NamesOfNodesAreAcceptedAndAmbiguousOnesRefused) {
  scene::Scene s;
  s.path = "test.glb";
  for (const char* node : {"door", "window", "door 2"}) {
    scene::Camera camera;
    camera.name = "lens";
    camera.node = node;
    camera.vertical_fov = 0.1f * static_cast<float>(s.cameras.size() + 1);
    s.cameras.push_back(camera);
  }
  CameraOptions options;
  options.name = "window";
  EXPECT_FLOAT_EQ(choose_camera(s, options, 1.0f).vertical_fov, 0.2f);
  options.name = "2";
  EXPECT_FLOAT_EQ(choose_camera(s, options, 1.0f).vertical_fov, 0.3f);
  options.name = "lens";
  expect_refused_parts<BadOption>([&] { choose_camera(s, options, 1.0f); },
                                  {"camera", "lens", "several cameras in test.glb", "node window"});
}

}  // namespace
}  // namespace gatelight::renderer
