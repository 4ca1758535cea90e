// Blocks of the scalar code against blocks of the kernels, and the rules that only the scalar code knows.

#include <cmath>

#include "tests/renderer/shading/lanes.h"
#include "tests/support/light_scenes.h"
#include "tests/support/materials.h"

namespace gatelight::renderer {
namespace {

using namespace lanes;
using gatelight::testing::add_light;
using gatelight::testing::LitScene;

/// Lamps and a point light around the origin.
LitScene lit_scene() {
  Random random(31);
  scene::Scene scene;
  for (int i = 0; i < 20; ++i) {
    const Vec3 at = (4.0f + 10.0f * random.uniform_float()) * random_direction(random);
    add_light(scene, {{at, at + random_direction(random), at + random_direction(random)}}, Color(3, 2, 1),
              true);
  }
  scene.lights.push_back(gatelight::testing::point_light(Vec3(0, 6, 0), Color(30, 20, 10)));
  return LitScene(std::move(scene));
}

ScalarLane scalar_lane(const LanePoint& p) {
  ScalarLane lane;
  lane.bsdf.emplace(p.bsdf());
  lane.thin_walled = p.surface.material.thin_walled;
  return lane;
}

struct Blocks {
  SurfaceBlock kernels, scalar;
  std::vector<LanePoint> points;

  void add(const LanePoint& p) {
    put(kernels.points, p);
    put(scalar.points, p);
    scalar.scalar.push_back(scalar_lane(p));
    points.push_back(p);
  }
};

class ScalarShading : public ::testing::Test {
 protected:
  const LitScene lit = lit_scene();
  const LightArrays arrays{lit.lights};
  const Shading shading = make_shading(lit.lights, arrays);
};

/// The share of lanes in which a color differs by more than 2 %.
struct Differences {
  int lanes = 0, far = 0;

  void add(const Color& a, const Color& b) {
    ++lanes;
    far += ((a - b).abs() > 0.02f * (a.abs().max(b.abs())) + 1e-4f).any() ? 1 : 0;
  }
  double share() const { return far / static_cast<double>(lanes); }
};

TEST_F(ScalarShading, AgreesWithTheKernels) {
  ASSERT_NE(arrays.view(), nullptr);
  Random random(32);
  int lanes = 0, other = 0;
  Differences albedo, wide_albedo, direct, wide_direct, weight, wide_weight;
  for (int b = 0; b < 1500; ++b) {
    Shading separating = make_shading(lit.lights, arrays);
    if (b % 3 != 0) separating.separate_wide(0.3f);
    Blocks blocks;
    while (!blocks.kernels.full()) {
      LanePoint p = random_point(random);
      p.events_before_roulette = b % 2;
      p.throughput = Color(0.5f, 0.3f, 0.1f);
      blocks.add(p);
    }
    const bool narrow = b % 3 == 2;
    separating.scatter(blocks.kernels);
    separating.scatter(blocks.scalar);
    if (narrow) {
      separating.scatter_narrow(blocks.kernels, {2.0f, 0.9f});
      separating.scatter_narrow(blocks.scalar, {2.0f, 0.9f});
    }
    const ShadingBlock& k = blocks.kernels.points;
    const ShadingBlock& s = blocks.scalar.points;
    for (int lane = 0; lane < k.count; ++lane) {
      const LanePoint& p = blocks.points[static_cast<std::size_t>(lane)];
      if (p.wo.dot(p.surface.geometric_normal) < 2e-3f) continue;
      ++lanes;
      albedo.add(lane_color(k.albedo, lane), lane_color(s.albedo, lane));
      if (b % 3 != 0) wide_albedo.add(lane_color(k.wide_albedo, lane), lane_color(s.wide_albedo, lane));
      const bool black = !(lane_color(s.direct, lane) > 0.0f).any();
      // A random number at the border between two lights or lobes chooses another one.
      if (!black && k.light[lane] != s.light[lane]) ++other;
      if (black || k.light[lane] == s.light[lane]) {
        direct.add(lane_color(k.direct, lane), lane_color(s.direct, lane));
        if (b % 3 == 1) wide_direct.add(lane_color(k.wide_direct, lane), lane_color(s.wide_direct, lane));
      }
      if ((k.alive[lane] != 0) != (s.alive[lane] != 0)) ++other;
      if (!k.alive[lane] || !s.alive[lane]) continue;
      if ((lane_vector(k.wi, lane) - lane_vector(s.wi, lane)).norm() > 2e-3f) {
        ++other;
        continue;
      }
      ASSERT_EQ(k.is_delta[lane], s.is_delta[lane]);
      ASSERT_EQ(k.transmitted[lane], s.transmitted[lane]);
      ASSERT_EQ(k.next_seed[lane], s.next_seed[lane]);
      ASSERT_LT((lane_vector(k.next_origin, lane) - lane_vector(s.next_origin, lane)).norm(), 1e-5f);
      ASSERT_NEAR(k.spread[lane], s.spread[lane], 1e-5f);
      ASSERT_NEAR(k.survival[lane], s.survival[lane], 0.01f);
      weight.add(lane_color(k.weight, lane), lane_color(s.weight, lane));
      if (b % 3 == 1) wide_weight.add(lane_color(k.wide_weight, lane), lane_color(s.wide_weight, lane));
    }
  }
  EXPECT_LT(other, 0.01 * lanes);
  for (const Differences* d : {&albedo, &wide_albedo, &direct, &wide_direct, &weight, &wide_weight}) {
    EXPECT_GT(d->lanes, 2000);
    EXPECT_LT(d->share(), 2e-3);
  }
}

TEST_F(ScalarShading, ShadowRaysAreThoseOfTheKernels) {
  Random random(33);
  int rays = 0;
  for (int b = 0; b < 200; ++b) {
    Blocks blocks;
    while (!blocks.kernels.full()) blocks.add(random_point(random));
    shading.delta_light(blocks.kernels);
    shading.delta_light(blocks.scalar);
    const ShadingBlock& k = blocks.kernels.points;
    const ShadingBlock& s = blocks.scalar.points;
    for (int lane = 0; lane < k.count; ++lane) {
      if (!(lane_color(k.direct, lane) > 0.0f).any() || !(lane_color(s.direct, lane) > 0.0f).any()) continue;
      ++rays;
      ASSERT_LT((lane_vector(k.shadow_origin, lane) - lane_vector(s.shadow_origin, lane)).norm(), 1e-5f);
      ASSERT_NEAR(k.shadow_length[lane], s.shadow_length[lane], 1e-4f);
      ASSERT_EQ(k.shadow_seed[lane], s.shadow_seed[lane]);
    }
  }
  EXPECT_GT(rays, 500);
}

/// White glass: a sheet, or the outside of a body.
LanePoint glass(float roughness, bool thin) {
  LanePoint p;
  p.surface.geometric_normal = p.surface.shading_normal = p.surface.coat_normal = Vec3::UnitZ();
  p.surface.offset = 1e-5f;
  p.wo = Vec3(0.3f, 0.2f, 0.9f).normalized();
  p.surface.material.transmission = 1.0f;
  p.surface.material.roughness = roughness;
  p.surface.material.ior = 1.5f;
  p.surface.material.thin_walled = thin;
  return p;
}

TEST_F(ScalarShading, PathsThatOnlyPassPanesTakeNoLightAndNoOtherLobe) {
  int passed = 0, ended = 0;
  for (std::uint32_t i = 0; i < 400; ++i) {
    Blocks blocks;
    LanePoint p = glass(i % 2 == 0 ? 0.0f : 0.5f, true);
    p.sampler = Sampler(SamplerKind::independent, 1, i, 0, 0);
    blocks.add(p);
    blocks.scalar.scalar[0].only_panes = true;
    shading.scatter(blocks.scalar);
    const ShadingBlock& s = blocks.scalar.points;
    ASSERT_TRUE((lane_color(s.direct, 0) == 0.0f).all());
    if (!s.alive[0]) {
      ++ended;
      continue;
    }
    ++passed;
    ASSERT_TRUE(s.is_delta[0] && s.transmitted[0]);
    ASSERT_EQ(lane_vector(s.wi, 0), Vec3(-p.wo));
  }
  EXPECT_GT(passed, 100);
  EXPECT_GT(ended, 200);
}

TEST_F(ScalarShading, LightFromBehindIsLeftOutWhereBouncesFindIt) {
  int front = 0, behind = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    for (const bool front_lights : {false, true}) {
      Blocks blocks;
      LanePoint p = glass(0.6f, false);
      p.sampler = Sampler(SamplerKind::independent, 2, i, 0, 0);
      blocks.add(p);
      blocks.scalar.scalar[0].front_lights = front_lights;
      shading.scatter(blocks.scalar);
      const ShadingBlock& s = blocks.scalar.points;
      if (!(lane_color(s.direct, 0) > 0.0f).any()) continue;
      const bool below = s.light_direction[2][0] < 0.0f;
      ASSERT_FALSE(front_lights && below);
      (below ? behind : front) += 1;
    }
  }
  EXPECT_GT(front, 100);
  EXPECT_GT(behind, 50);
}

TEST_F(ScalarShading, WeightsLeaveOutTheRadianceScaleOfRefraction) {
  int refracted = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    Blocks blocks;
    LanePoint p = glass(i % 2 == 0 ? 0.0f : 0.4f, false);
    p.sampler = Sampler(SamplerKind::independent, 3, i, 0, 0);
    blocks.add(p);
    shading.scatter(blocks.scalar);
    const ShadingBlock& s = blocks.scalar.points;
    const BsdfSample expected = p.sample(p.bsdf());
    ASSERT_EQ(s.alive[0] != 0, expected.pdf > 0.0f && (expected.weight > 0.0f).any());
    if (!s.alive[0]) continue;
    const float scale = blocks.scalar.scalar[0].radiance_scale;
    ASSERT_EQ(scale, expected.radiance_scale);
    for (int c = 0; c < 3; ++c) ASSERT_FLOAT_EQ(s.weight[c][0] * scale, expected.weight[c]);
    if (s.transmitted[0]) {
      ++refracted;
      ASSERT_NEAR(scale, 1.0f / 2.25f, 1e-5f);
    }
  }
  EXPECT_GT(refracted, 100);
}

}  // namespace
}  // namespace gatelight::renderer
