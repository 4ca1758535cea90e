// Coarse round meshes: light that reaches the round surface is not hidden by the flat triangles.

#include "renderer/surface/shadow_terminator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"
#include "tests/renderer/surface/tracer.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

Vec2 random_2d(std::uint32_t i, std::uint32_t dimension) {
  return Sampler(SamplerKind::independent, 1, 0, 0, i).get_2d(dimension);
}

/// The share that points of a ball lose of the cosine-weighted light from above their smooth horizon.
double lost_light(const scene::Scene& ball) {
  const Tracer world(ball);
  int lost = 0, all = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const Vec3 origin = 3.0f * sample_uniform_sphere(random_2d(i, 0));
    const Vec3 direction = (0.7f * sample_uniform_sphere(random_2d(i, 2)) - origin).normalized();
    const Hit hit = world.hit(origin, direction);
    if (!hit) continue;
    const Surface surface = world.surfaces.at(hit, direction, 0.0f, 0.5f);
    const Vec3 wi = Basis(surface.smooth_normal).to_world(sample_cosine_hemisphere(random_2d(i, 4)));
    const bool above = wi.dot(surface.geometric_normal) > 0.0f;
    all += 1;
    lost += above && world.passed(surface.spawn(wi), wi, kInfinity, i).x() > 0.0f ? 0 : 1;
  }
  return lost / static_cast<double>(all);
}

scene::Scene ball(int segments, bool smooth, const scene::Material& material) {
  SceneBuilder builder;
  builder.sphere(builder.material(material), Vec3(0, 0, 0), 1.0f, segments, smooth);
  return builder.scene();
}

TEST(ShadowTerminator, ABallLosesNoLightToItsTriangles) {
  for (const int segments : {12, 24, 48}) {
    const scene::Material clay = SceneBuilder::lambert(Color::Ones());
    EXPECT_LT(lost_light(ball(segments, true, clay)), 1e-4) << segments;
    EXPECT_LT(lost_light(ball(segments, false, clay)), 1e-4) << segments;
  }
}

TEST(ShadowTerminator, PlacedAndMirroredBallsLoseNoLight) {
  scene::Scene placed = ball(12, true, SceneBuilder::lambert(Color::Ones()));
  for (const Vec3& scale : {Vec3(0.9f, 0.9f, 0.9f), Vec3(-0.9f, 0.9f, 0.9f)}) {
    placed.instances[0].baked = false;
    placed.instances[0].transform = Affine(Eigen::AngleAxisf(0.4f, Vec3(1, 2, 3).normalized())).scale(scale);
    placed.instances[0].swaps_handedness = scale.x() < 0.0f;
    EXPECT_LT(lost_light(placed), 1e-4);
  }
}

/// The surface that a ray from `eye` to `target` hits.
Surface seen(const scene::Scene& s, const Vec3& eye, const Vec3& target) {
  const Tracer world(s);
  const Vec3 direction = (target - eye).normalized();
  const Hit hit = world.hit(eye, direction);
  EXPECT_TRUE(hit);
  return world.surfaces.at(hit, direction, 0.0f, 0.5f);
}

TEST(ShadowTerminator, PointsRiseBetweenTheTrianglesAndTheTangentPlanes) {
  const scene::Scene s = ball(12, true, SceneBuilder::lambert(Color::Ones()));
  // The middle of an edge of the equator, and a quarter of it.
  const float half = kPi / 12.0f;
  for (const float at : {0.5f, 0.25f}) {
    const Vec3 a(1, 0, 0), b(std::cos(2.0f * half), 0, -std::sin(2.0f * half));
    const Vec3 on_edge = a + (b - a) * at + Vec3(0, 1e-4f, 0);
    const float radius = seen(s, 3.0f * on_edge, on_edge).position.norm();
    EXPECT_GT(radius, on_edge.norm());
    EXPECT_GT(radius, 0.999f);
    EXPECT_LT(radius, 1.0f / std::cos(half));
  }
}

TEST(ShadowTerminator, FlatHollowAndTransparentSurfacesStayWhereTheyAre) {
  const Vec3 eye(0.3f, 0.4f, 2.5f), target(0.05f, 0.1f, 0.0f);
  const auto stays = [&](const scene::Scene& s, const Vec3& from) {
    const Tracer world(s);
    const Vec3 direction = (target - from).normalized();
    const Hit hit = world.hit(from, direction);
    const Surface surface = world.surfaces.at(hit, direction, 0.0f, 0.5f);
    const Vec3 ng = scene::world_normal(s, s.instances[0], hit.primitive);
    return (surface.position - (from + hit.t * direction)).norm() < 1e-5f &&
           std::abs(std::abs(surface.geometric_normal.dot(ng)) - 1.0f) < 1e-6f;
  };
  const scene::Material clay = SceneBuilder::lambert(Color::Ones());
  scene::Material glass = SceneBuilder::clear_glass();
  EXPECT_FALSE(stays(ball(12, true, clay), eye));
  EXPECT_TRUE(stays(ball(12, false, clay), eye));
  EXPECT_TRUE(stays(ball(12, true, clay), Vec3(0, 0.05f, -0.4f))) << "seen from its inside";
  EXPECT_TRUE(stays(ball(12, true, glass), eye));
  glass.thickness = 1.0f;
  EXPECT_TRUE(stays(ball(12, true, glass), eye));
}

}  // namespace
}  // namespace gatelight::renderer
