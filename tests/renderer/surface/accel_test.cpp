#include "renderer/surface/accel.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/errors.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"
#include "tests/renderer/surface/tracer.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

Vec3 random_direction(std::uint32_t i) {
  return sample_uniform_sphere(Sampler(SamplerKind::independent, 1, 0, 0, i).get_2d(0));
}

TEST(Accel, BatchesOfAnySizeAgreeWithSingleRays) {
  SceneBuilder builder;
  const int m = builder.material(SceneBuilder::lambert(Color::Ones()));
  builder.sphere(m, Vec3(0, 0, 0), 1.0f, 24, true);
  builder.quad(m, Vec3(-5, -2, 5), Vec3(10, 0, 0), Vec3(0, 0, -10));
  const Tracer tracer(builder.scene());
  for (std::size_t n : {0u, 1u, 15u, 16u, 17u, 100u}) {
    std::vector<Ray> rays(n);
    for (std::size_t i = 0; i < n; ++i) {
      rays[i].origin = Vec3(0, 0.5f, 3);
      rays[i].direction =
          (Vec3(0, 0, -1) + 0.5f * random_direction(static_cast<std::uint32_t>(i))).normalized();
    }
    std::vector<Hit> hits(n);
    tracer.accel.intersect(rays, hits, false);
    for (std::size_t i = 0; i < n; ++i) {
      const Hit one = tracer.hit(rays[i].origin, rays[i].direction);
      ASSERT_EQ(one.instance, hits[i].instance);
      if (one) {
        EXPECT_NEAR(one.t, hits[i].t, 1e-5f * one.t);
      }
    }
  }
}

TEST(Accel, RaysPassCulledBackFaces) {
  SceneBuilder builder;
  scene::Material clay = SceneBuilder::lambert(Color::Ones());
  clay.culled = true;
  builder.quad(builder.material(clay), Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  scene::Scene& s = builder.scene();
  const auto expect_culled_from_behind = [&] {
    const Tracer tracer(s);
    const Vec3 front(0.1f, 0.2f, 1), back(0.1f, 0.2f, -1);
    EXPECT_TRUE(tracer.hit(front, Vec3(0, 0, -1)));
    EXPECT_FALSE(tracer.hit(back, Vec3(0, 0, 1)));
    EXPECT_TRUE((tracer.passed(front, Vec3(0, 0, -1), 2.0f) == 0.0f).all());
    EXPECT_TRUE((tracer.passed(back, Vec3(0, 0, 1), 2.0f) == 1.0f).all());
  };
  expect_culled_from_behind();
  s.instances[0].baked = false;
  expect_culled_from_behind();
  // A mirrored node keeps its fronts in front.
  s.instances[0].transform.linear().col(0) = Vec3(-1, 0, 0);
  s.instances[0].swaps_handedness = true;
  expect_culled_from_behind();
}

/// From a metre scene of millimetres to one of a thousand kilometres, and far from the origin.
TEST(Accel, RaysLeaveTheirSurfaceAndCannotLeaveAClosedRoom) {
  for (const auto& [scale, shift] : {std::pair{1e-3f, 0.0f},
                                     {1.0f, 0.0f},
                                     {1e3f, 0.0f},
                                     {1e6f, 0.0f},
                                     {1.0f, 100.0f},
                                     {1.0f, 1000.0f},
                                     {1e-3f, 1.0f}}) {
    SCOPED_TRACE(::testing::Message() << scale << " " << shift);
    const Vec3 offset = Vec3(1.0f, -0.6f, 0.3f) * shift;
    SceneBuilder builder;
    const int m = builder.material(SceneBuilder::lambert(Color::Ones()));
    builder.box(m, Vec3(-1, -1, -1) * scale + offset, Vec3(1, 1, 1) * scale + offset, true);
    builder.sphere(m, Vec3(0.2f, -0.3f, 0.1f) * scale + offset, 0.4f * scale, 32, false);
    const Tracer tracer(builder.scene());
    int self_hits = 0;
    int escapes = 0;
    constexpr int kWalks = 2000;
    for (std::uint32_t i = 0; i < kWalks; ++i) {
      Vec3 origin = Vec3(0.7f, 0.6f, 0.7f) * scale + offset;
      Vec3 direction = random_direction(i);
      for (std::uint32_t bounce = 0; bounce < 6; ++bounce) {
        const Hit hit = tracer.hit(origin, direction);
        if (!hit) {
          ++escapes;
          break;
        }
        // Every surface is more than this far from any other along a ray that leaves it, but for grazing rays
        // in corners.
        const Surface s = tracer.surfaces.at(hit, direction, 0.0f, 0.0f);
        ASSERT_TRUE(s.front);
        const Vec3 next = Basis(s.geometric_normal)
                              .to_world(sample_cosine_hemisphere(
                                  Sampler(SamplerKind::independent, 2, i, bounce, 0).get_2d(3)));
        const Vec3 start = s.spawn(next);
        const Hit again = tracer.hit(start, next);
        if (again && again.instance == hit.instance && again.primitive == hit.primitive) ++self_hits;
        origin = start;
        direction = next;
      }
    }
    EXPECT_EQ(self_hits, 0);
    EXPECT_EQ(escapes, 0);
  }
}

TEST(Accel, OnlyAWatertightSceneStopsRaysTowardsItsEdges) {
  SceneBuilder builder;
  builder.sphere(builder.material(SceneBuilder::lambert(Color::Ones())), Vec3(0.1f, 0.2f, 0.3f), 1.0f, 32,
                 true);
  scene::Scene ball = builder.scene();
  scene::Mesh& mesh = ball.meshes[0];
  // Corners at the same place become the same floats, so that the ball is closed.
  for (Vec3& p : mesh.positions) p = (p * 64.0f).array().round() / 64.0f;
  const auto leaks = [&](bool watertight) {
    const Tracer tracer(ball, {.watertight = watertight});
    int leaked = 0;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      const Sampler sampler(SamplerKind::independent, 3, i, 0, 0);
      const auto& corners = mesh.triangles[i % mesh.triangles.size()];
      const float along = sampler.get_1d(0);
      const Vec3 target = mesh.positions[corners[0]] * along + mesh.positions[corners[1]] * (1.0f - along);
      const Vec3 origin = Vec3(0.1f, 0.2f, 0.3f) + 0.3f * random_direction(i);
      if (!tracer.hit(origin, (target - origin).normalized())) ++leaked;
    }
    return leaked;
  };
  EXPECT_EQ(leaks(true), 0);
  EXPECT_GT(leaks(false), 0);
}

TEST(Accel, InstancesReportTheirIndexAndWorldGeometry) {
  SceneBuilder builder;
  const int m = builder.material(SceneBuilder::lambert(Color::Ones()));
  builder.quad(m, Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  scene::Scene& s = builder.scene();
  s.instances[0].baked = false;
  s.instances.push_back(s.instances[0]);
  s.instances[1].transform = Affine(Eigen::Translation3f(5, 0, 0));
  s.instances[1].transform.linear() = Vec3(-1, 1, 1).asDiagonal();
  s.instances[1].swaps_handedness = true;
  const Tracer tracer(s);
  const Hit first = tracer.hit(Vec3(0, 0, 4), Vec3(0, 0, -1));
  const Hit second = tracer.hit(Vec3(5.2f, 0.1f, 4), Vec3(0, 0, -1));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first.instance, 0u);
  EXPECT_EQ(second.instance, 1u);
  const Surface surface = tracer.surfaces.at(second, Vec3(0, 0, -1), 0, 0);
  EXPECT_TRUE(surface.position.isApprox(Vec3(5.2f, 0.1f, 0), 1e-5f));
  // A mirrored quad still shows its front to where the front was.
  EXPECT_TRUE(surface.front);
  EXPECT_TRUE(surface.geometric_normal.isApprox(Vec3(0, 0, 1), 1e-6f));
}

TEST(Accel, AlphaMaskLetsRaysThrough) {
  SceneBuilder builder;
  scene::Material m = SceneBuilder::lambert(Color::Ones());
  m.alpha_mode = scene::AlphaMode::mask;
  m.base_alpha = 0.4f;
  builder.quad(builder.material(m), Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  m.base_alpha = 0.6f;
  builder.quad(builder.material(m), Vec3(-1, -1, -1), Vec3(2, 0, 0), Vec3(0, 2, 0));
  const Tracer tracer(builder.scene());
  EXPECT_EQ(tracer.hit(Vec3(0.1f, 0.2f, 1), Vec3(0, 0, -1)).instance, 1u);
  EXPECT_TRUE((tracer.passed(Vec3(0.1f, 0.2f, 1), Vec3(0, 0, -1), 1.5f) == 1.0f).all());
  EXPECT_TRUE((tracer.passed(Vec3(0.1f, 0.2f, 1), Vec3(0, 0, -1), 2.5f) == 0.0f).all());
}

TEST(Accel, BlendPassesTheRightFractionIndependentlyBySurface) {
  SceneBuilder builder;
  scene::Material m = SceneBuilder::lambert(Color::Ones());
  m.alpha_mode = scene::AlphaMode::blend;
  m.base_alpha = 0.3f;
  const int blend = builder.material(m);
  builder.quad(blend, Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  builder.quad(blend, Vec3(-1, -1, -1), Vec3(2, 0, 0), Vec3(0, 2, 0));
  const Tracer tracer(builder.scene());
  constexpr int kCount = 20000;
  int passed = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    passed += tracer.passed(Vec3(0.1f, 0.2f, 1), Vec3(0, 0, -1), 5.0f, hash(i)).x() > 0.0f;
  }
  // 0.49 of the rays, within five standard deviations.
  EXPECT_NEAR(passed, 0.49 * kCount, 5.0 * std::sqrt(kCount * 0.49 * 0.51));
}

TEST(Accel, ClearPanesTintShadowsAndOpaqueThingsStopThem) {
  SceneBuilder builder;
  scene::Material glass = SceneBuilder::clear_glass();
  glass.base_color = Color(1.0f, 0.5f, 0.0f);
  const int pane = builder.material(glass);
  builder.quad(pane, Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  builder.quad(pane, Vec3(-1, -1, -1), Vec3(2, 0, 0), Vec3(0, 2, 0));
  const Tracer tracer(builder.scene());
  const Color one = tracer.passed(Vec3(0.1f, 0.2f, 0.5f), Vec3(0, 0, -1), 1.0f);
  const Color two = tracer.passed(Vec3(0.1f, 0.2f, 0.5f), Vec3(0, 0, -1), 2.0f);
  // At least the Fresnel loss of one face, at most that of both with everything in between lost.
  EXPECT_GT(one.x(), 0.91f);
  EXPECT_LT(one.x(), 0.961f);
  EXPECT_NEAR(one.y(), 0.5f * one.x(), 0.03f);
  EXPECT_EQ(one.z(), 0.0f);
  EXPECT_TRUE(two.isApprox(one * one, 1e-4f));
}

TEST(Accel, RefusesAnUnknownIsaAndAMemoryLimitThatIsTooSmall) {
  SceneBuilder builder;
  builder.sphere(builder.material(SceneBuilder::lambert(Color::Ones())), Vec3(0, 0, 0), 1.0f, 400, false);
  EXPECT_THROW(
      Tracer(builder.scene(), AccelOptions{.threads = 0, .isa = "auto", .memory_limit_bytes = 1 << 20}),
      OutOfMemory);
  EXPECT_NO_THROW(
      Tracer(builder.scene(), AccelOptions{.threads = 0, .isa = "scalar", .memory_limit_bytes = 0}));
}

TEST(Accel, AnEmptySceneHasNoHits) {
  const scene::Scene empty;
  const Tracer tracer(empty);
  EXPECT_FALSE(tracer.hit(Vec3(0, 0, 0), Vec3(0, 0, -1)));
}

}  // namespace
}  // namespace gatelight::renderer
