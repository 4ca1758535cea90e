// Rays through bodies that share a face, after their surfaces were separated.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "renderer/transport/world.h"
#include "scene/coincident_surfaces.h"
#include "tests/support/absorbing_bodies.h"
#include "tests/support/picture_moments.h"
#include "tests/support/random_points.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::AbsorbingBodies;
using testing::SceneBuilder;

// Of the means of this file.
const double kTouchingSignificance = testing::sidak(1e-4, 12);

const std::vector<Box> kRowOfBoxes = {Box(Vec3(-1, -1, -1), Vec3(0, 1, 1)),
                                      Box(Vec3(0, -0.8f, -0.9f), Vec3(1, 1, 1)),
                                      Box(Vec3(1, -0.7f, -1), Vec3(2, 0.8f, 1))};
const std::vector<Color> kRowOfMedia = {Color(0.3f, 0.0f, 0.6f), Color(0.0f, 0.8f, 0.2f),
                                        Color(0.5f, 0.4f, 0.0f)};

/// Calls use(bodies) for each order of two and three boxes in a row.
template <class Use>
void each_order(const Use& use) {
  for (const std::size_t count : {2u, 3u}) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    do {
      AbsorbingBodies bodies;
      for (const std::size_t place : order) bodies.add(kRowOfBoxes[place], kRowOfMedia[place]);
      scene::separate_coincident_surfaces(bodies.scene());
      SCOPED_TRACE(::testing::PrintToString(order));
      use(bodies);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(TouchingBodies, FollowBeersLawForCameraRays) {
  each_order([](AbsorbingBodies& bodies) {
    for (const Vec3& eye : {Vec3(6, 0.3f, 0.4f), Vec3(-4, 3, 2), Vec3(0.4f, 0.1f, 0.2f), Vec3(-0.3f, 0, 0)}) {
      bodies.options.camera.look_at = LookAt{eye, Vec3(0.45f, -0.05f, 0.05f), Vec3(0, 1, 0)};
      SCOPED_TRACE(eye.transpose());
      bodies.expect_beers_law();
    }
  });
}

TEST(TouchingBodies, FollowBeersLawForShadowRays) {
  each_order([](AbsorbingBodies& bodies) {
    const World world(bodies.scene(), {.glass_shadows = GlassShadows::straight});
    // Along the row: at grazing angles unrefracted glass reflects even without an index (Schlick).
    testing::Random random(4);
    for (int i = 0; i < 500; ++i) {
      const Vec2 a = testing::next_2d(random) - Vec2::Constant(0.5f);
      const Vec2 b = testing::next_2d(random) - Vec2::Constant(0.5f);
      const float side = i % 2 == 0 ? 9.0f : -9.0f;
      const Vec3 direction = (Vec3(-side, b.x(), b.y()) - Vec3(side, a.x(), a.y())).normalized();
      // From outside, or from between the ends of the row.
      const float x = i % 4 < 2 ? side : -1.2f + 3.4f * random.uniform_float();
      const Ray ray{
          .origin = Vec3(x, 0.5f * a.x(), 0.5f * a.y()), .t_max = kInfinity, .direction = direction};
      Color passed;
      world.accel.transmittance({&ray, 1}, {&passed, 1});
      const Color expected = bodies.transmittance(ray.origin, ray.direction);
      ASSERT_LT((passed - expected).abs().maxCoeff(), 1e-3f)
          << i << ": " << passed.transpose() << ", expected " << expected.transpose();
    }
  });
}

TEST(TouchingBodies, ThatAreStretchedFollowBeersLaw) {
  // The rounding of a stretched instance, and so the offset of rays, is larger.
  AbsorbingBodies bodies;
  bodies.add(Box(Vec3(-1, -1, -1), Vec3(0, 1, 1)), kRowOfMedia[0]);
  bodies.add(Box(Vec3(0, -1, -1), Vec3(1, 1, 1)), kRowOfMedia[1]);
  for (scene::Instance& instance : bodies.scene().instances) {
    instance.baked = false;
    instance.transform.linear() = Vec3(1, 50, 1).asDiagonal();
    for (Vec3& p : bodies.scene().meshes[static_cast<std::size_t>(instance.mesh)].positions) p.y() /= 50.0f;
  }
  scene::separate_coincident_surfaces(bodies.scene());
  bodies.options.camera.look_at = LookAt{Vec3(5, 0.3f, 0.4f), Vec3(0, 0, 0), Vec3(0, 1, 0)};
  bodies.expect_beers_law(4e-3f);
}

TEST(TouchingBodies, ThatLoseNothingAreInvisibleInAFurnace) {
  for (const float ior : {1.0f, 1.4f}) {
    for (const bool scatters_left : {false, true}) {
      for (const Vec3& eye : {Vec3(5, 0.2f, 0.3f), Vec3(-5, 0.2f, 0.3f)}) {
        SceneBuilder builder;
        for (const bool left : {false, true}) {
          scene::Material m = testing::solid_glass(ior);
          if (left == scatters_left) {
            m.attenuation_distance = 0.4f;
            m.attenuation_color.setConstant(0.3f);
            m.multiscatter_color.setOnes();
          }
          builder.box(builder.material(m), kRowOfBoxes[left ? 0 : 1].min(), kRowOfBoxes[left ? 0 : 1].max());
          builder.scene().instances.back().placement = left ? 0 : 1;
        }
        scene::separate_coincident_surfaces(builder.scene());
        RenderOptions options;
        options.width = options.height = 16;
        options.spp = 24;
        options.max_depth = options.min_depth = 100000;
        options.environment.constant = Color::Ones();
        options.camera.look_at = LookAt{eye, Vec3::Zero(), Vec3(0, 1, 0)};
        options.camera.fov_degrees = 18.0f;
        const testing::Moments moments =
            testing::channel_moments(Renderer(builder.scene(), options).render(), 1);
        EXPECT_GT(testing::mean_p_value(moments, 1.0, 1e-3), kTouchingSignificance)
            << ior << scatters_left << eye.transpose() << ": " << moments.mean() << " +- "
            << moments.standard_error();
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
