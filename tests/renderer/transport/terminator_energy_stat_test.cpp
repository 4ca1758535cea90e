// Points of coarse balls are moved onto the round surface: this neither loses light nor lets it into closed
// rooms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {
using testing::Moments;
using testing::SceneBuilder;

RenderOptions looking(const Vec3& eye, float fov_degrees) {
  RenderOptions options;
  options.width = options.height = 32;
  options.spp = 64;
  options.max_depth = 64;
  options.threads = 2;
  options.camera.look_at = LookAt{eye, Vec3::Zero(), Vec3(0, 1, 0)};
  options.camera.fov_degrees = fov_degrees;
  return options;
}

Moments pixels(const scene::Scene& s, const RenderOptions& options) {
  return testing::moments_of(Renderer(s, options).render());
}

/// A normal map all over a ball, which leans the normals by some 20 degrees to and fro.
void make_rough(scene::Scene& s, scene::Mesh& ball, scene::Material& material) {
  scene::Image map{.name = "bumps", .width = 2, .height = 2, .channels = 3};
  map.pixels = {168, 128, 248, 88, 128, 248, 128, 168, 248, 128, 88, 248};
  s.images.push_back(map);
  s.textures.push_back({.image = 0, .nearest = true});
  material.normal_texture.texture = 0;
  for (const Vec3& n : ball.normals) {
    const Vec3 tangent = any_perpendicular(n);
    ball.tangents.emplace_back(tangent.x(), tangent.y(), tangent.z(), 1.0f);
    ball.uv0.emplace_back(7.0f * n.x(), 7.0f * n.y());
  }
}

/// Pixels of a white ball in a sky of radiance 1, from the whole of it.
Moments white_ball(int segments, DirectLight direct, bool two_sided, bool bumps) {
  SceneBuilder builder;
  scene::Material white = SceneBuilder::lambert(Color::Ones());
  white.double_sided = two_sided;
  scene::Mesh& ball = builder.sphere(builder.material(white), Vec3::Zero(), 1.0f, segments, true);
  if (bumps) make_rough(builder.scene(), ball, builder.scene().materials[0]);
  RenderOptions options = looking(Vec3(0.5f, 0.3f, 4.0f), 30.0f);
  options.environment.constant = Color::Ones();
  options.direct = direct;
  return pixels(builder.scene(), options);
}

TEST(TerminatorEnergy, AWhiteBallInAWhiteSkyIsInvisible) {
  for (const DirectLight direct : {DirectLight::mis, DirectLight::nee, DirectLight::bsdf}) {
    for (const int segments : {12, 24, 48}) {
      for (const bool two_sided : {false, true}) {
        const Moments ball = white_ball(segments, direct, two_sided, false);
        EXPECT_GT(testing::mean_p_value(ball, 1.0), testing::sidak(1e-4, 18))
            << segments << " segments, mean " << ball.mean() << " +- " << ball.standard_error();
      }
    }
  }
}

TEST(TerminatorEnergy, UnderANormalMapACoarseBallIsAsBrightAsAFineOne) {
  const Moments fine = white_ball(192, DirectLight::mis, false, true);
  for (const int segments : {12, 24, 48}) {
    const Moments coarse = white_ball(segments, DirectLight::mis, false, true);
    const double error = std::hypot(coarse.standard_error(), fine.standard_error());
    const double freedom = static_cast<double>(coarse.count() + fine.count() - 2);
    EXPECT_GT(testing::student_two_sided((coarse.mean() - fine.mean()) / error, freedom),
              testing::sidak(1e-4, 3))
        << segments << " segments, mean " << coarse.mean() << ", expected " << fine.mean() << " +- " << error;
  }
}

/// The brightest pixel of a closed black room with a sun and a sky outside.
double leak(scene::Scene& room, const RenderOptions& inside) {
  room.lights.push_back(testing::sun(Vec3(-0.6f, -0.7f, -0.4f), Color::Constant(1000.0f)));
  RenderOptions options = inside;
  options.environment.constant = Color::Constant(100.0f);
  const Picture picture = Renderer(room, options).render();
  return static_cast<double>(
      *std::max_element(picture.layers[0].values.begin(), picture.layers[0].values.end()));
}

TEST(TerminatorEnergy, NoLightComesIntoAClosedRoomWithBallsNearItsWalls) {
  SceneBuilder builder;
  scene::Material clay = SceneBuilder::lambert(Color::Constant(0.8f));
  const int plain = builder.material(clay);
  clay.double_sided = true;
  const int two_sided = builder.material(clay);
  builder.box(plain, Vec3(-2, -1, -2), Vec3(2, 1, 2), true);
  // 6 cm over the floor, from a corner, and below the roof: a tenth of a radius.
  builder.sphere(plain, Vec3(0, -0.34f, 0), 0.6f, 12, true);
  builder.sphere(two_sided, Vec3(-1.34f, 0.34f, -1.34f), 0.6f, 12, true);
  builder.sphere(two_sided, Vec3(1.2f, 0.34f, -0.5f), 0.6f, 24, true);
  EXPECT_EQ(leak(builder.scene(), looking(Vec3(0.2f, 0.1f, 1.9f), 80.0f)), 0.0);
}

/// Mean radiance of a ball that lies on a floor, in a sky, and the same without the floor.
TEST(TerminatorEnergy, ABallOnAFloorHardlyGetsLightFromBelowIt) {
  const auto lit_from_below = [](int segments, bool floor) {
    SceneBuilder builder;
    builder.sphere(builder.material(SceneBuilder::lambert(Color::Ones())), Vec3(0, 1, 0), 1.0f, segments,
                   true);
    if (floor) testing::add_floor(builder, SceneBuilder::lambert(Color::Zero()), 50);
    scene::Scene& s = builder.scene();
    s.lights.push_back(testing::sun(Vec3(0.5f, 0.8f, 0)));
    RenderOptions options = looking(Vec3(0, 0.5f, 4), 40.0f);
    options.camera.look_at->target = Vec3(0, 0.5f, 0);
    options.max_depth = 1;
    return pixels(s, options).mean();
  };
  for (const int segments : {12, 24, 48}) {
    const double share = lit_from_below(segments, true) / lit_from_below(segments, false);
    std::printf("%d segments: %.2e of the light from below the floor\n", segments, share);
    EXPECT_LT(share, 0.01) << segments;
  }
}

TEST(TerminatorEnergy, NoLightComesIntoARoundRoomSeenFromItsInside) {
  SceneBuilder builder;
  scene::Material clay = SceneBuilder::lambert(Color::Constant(0.8f));
  clay.double_sided = true;
  builder.sphere(builder.material(clay), Vec3::Zero(), 2.0f, 12, true);
  builder.sphere(builder.material(clay), Vec3(0, -1.2f, 0), 0.5f, 12, true);
  EXPECT_EQ(leak(builder.scene(), looking(Vec3(0.2f, 0.1f, 1.5f), 80.0f)), 0.0);
}

}  // namespace
}  // namespace gatelight::renderer
