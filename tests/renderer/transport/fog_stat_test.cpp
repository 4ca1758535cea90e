// Fog in the bounds of a scene: closed forms, and estimators that must agree.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/medium/equiangular.h"
#include "renderer/medium/phase.h"
#include "renderer/render.h"
#include "renderer/transport/world.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"
#include "tests/support/random_points.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;

TEST(EquiangularDistances, SamplesFollowTheDensity) {
  constexpr int kBins = 40, kSamples = 100000;
  testing::Random random(3);
  const Vec3 origin(1, 2, 3), direction = Vec3(1, -2, 0.5f).normalized();
  for (const float height : {1e-3f, 0.3f, 20.0f}) {
    for (const Span& span : {Span{0.0f, 4.0f}, Span{2.5f, 7.0f}}) {
      const Vec3 lamp = origin + 3.0f * direction + height * any_perpendicular(direction);
      const EquiangularDistances near(origin, direction, span, lamp);
      // The distribution function is the angle at the lamp.
      const auto angle = [&](double t) { return std::atan((t - 3.0) / static_cast<double>(height)); };
      const double begin = angle(span.begin), all = angle(span.end) - begin;
      std::vector<double> observed(kBins, 0.0);
      for (int i = 0; i < kSamples; ++i) {
        const float t = near.sample(random.uniform_float());
        ASSERT_GE(t, span.begin - 1e-4f);
        ASSERT_LE(t, span.end + 1e-4f);
        const double place = (angle(static_cast<double>(t)) - begin) / all * kBins;
        observed[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0))] += 1.0;
        const double density =
            static_cast<double>(height) / all /
            (static_cast<double>(height * height) + std::pow(static_cast<double>(t) - 3.0, 2));
        ASSERT_NEAR(static_cast<double>(near.pdf(t)), density, 2e-2 * density);
      }
      const std::vector<double> expected(kBins, static_cast<double>(kSamples) / kBins);
      EXPECT_GT(testing::chi_square_test(observed, expected).p_value, 1e-6) << height << " " << span.begin;
    }
  }
}

/// The bounds of the scene are a box of black walls, 2 m wide, and 8 m along the z axis.
SceneBuilder dark_hall(float wall = 0.0f) {
  SceneBuilder builder;
  builder.box(builder.material(SceneBuilder::lambert(Color::Constant(wall))), Vec3(-1, -1, -8), Vec3(1, 1, 0),
              true);
  return builder;
}

RenderOptions options_of(const FogOptions& fog) {
  RenderOptions options;
  options.width = options.height = 8;
  options.spp = 64;
  options.environment.fog = fog;
  options.camera.look_at = LookAt{Vec3(0, 0, -0.1f), Vec3(0, 0, -8), Vec3(0, 1, 0)};
  options.camera.fov_degrees = 0.01f;
  return options;
}

TEST(Fog, AttenuatesShadowRaysOnlyInItsBoxAndOutsideOfBodies) {
  constexpr double kDensity = 0.3;
  const EnvironmentOptions environment{.fog = FogOptions{.density = static_cast<float>(kDensity)}};
  for (const GlassShadows glass : {GlassShadows::refract, GlassShadows::straight}) {
    SceneBuilder builder;
    builder.scene().bounds = Box(Vec3(-1, -1, -2), Vec3(1, 1, 0));
    const auto passed = [&](float z, float length) {
      const World world(builder.scene(), {.environment = environment, .glass_shadows = glass});
      Ray ray{.origin = Vec3(0.1f, 0.2f, z), .t_max = length, .direction = Vec3(0, 0, -1)};
      ray.inside = world.media.of(scene::kNoVolume).inside;
      Color result;
      world.accel.transmittance({&ray, 1}, {&result, 1});
      return static_cast<double>(result.x());
    };
    const auto after = [&](double metres) { return std::exp(-kDensity * metres); };
    EXPECT_NEAR(passed(-0.5f, 1.0f), after(1.0), 1e-3) << "inside";
    EXPECT_NEAR(passed(-0.5f, kInfinity), after(1.5), 3e-3) << "to a sun";
    EXPECT_NEAR(passed(5.0f, kInfinity), after(2.0), 3e-3) << "through";
    EXPECT_NEAR(passed(-3.0f, kInfinity), 1.0, 1e-6) << "behind";
    if (glass == GlassShadows::refract) continue;
    // A body of clear glass between -0.5 and -1.5.
    builder.box(builder.material(testing::solid_glass()), Vec3(-0.5f, -0.5f, -1.5f), Vec3(0.5f, 0.5f, -0.5f));
    builder.scene().instances.back().placement = 0;
    EXPECT_NEAR(passed(5.0f, kInfinity), 0.96 * 0.96 * after(1.0), 2e-3) << "through glass";
  }
}

TEST(Fog, ThatOnlyAbsorbsFollowsBeersLaw) {
  SceneBuilder builder = dark_hall();
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Ones())), Vec3(-1, -1, -7),
               Vec3(2, 0, 0), Vec3(0, 2, 0));
  RenderOptions options = options_of({.density = 0.2f, .albedo = Color::Zero()});
  options.spp = 1024;
  const Moments moments = testing::channel_moments(Renderer(builder.scene(), options).render(), 0);
  EXPECT_GT(testing::mean_p_value(moments, std::exp(-0.2 * 6.9), 1e-3), 1e-4) << moments.mean();
}

TEST(Fog, OfAlbedoOneIsInvisibleInAFurnace) {
  for (const float g : {-0.7f, 0.0f, 0.8f}) {
    SceneBuilder builder;
    builder.quad(builder.material(SceneBuilder::lambert(Color::Ones())), Vec3(-1, 0, -1), Vec3(0, 0, 2),
                 Vec3(2, 0, 0));
    builder.box(builder.material(testing::solid_glass()), Vec3(-0.4f, 0.1f, -0.4f), Vec3(0.4f, 0.9f, 0.4f));
    builder.scene().instances.back().placement = 0;
    RenderOptions options = options_of({.density = 2.0f, .anisotropy = g});
    options.environment.constant = Color::Ones();
    options.min_depth = 1 << 20;
    options.camera.look_at = LookAt{Vec3(0.5f, 1.5f, 3), Vec3(0, 0.4f, 0), Vec3(0, 1, 0)};
    options.camera.fov_degrees = 40.0f;
    const Moments moments = testing::moments_of(Renderer(builder.scene(), options).render());
    EXPECT_GT(testing::mean_p_value(moments, 1.0, 3e-3), 1e-4) << g << ": " << moments.mean();
  }
}

/// Single scattering by a quadrature: a point light beside the ray, at half of its length.
double scattered_once(double density, double albedo, double g, double height) {
  constexpr int kSteps = 200000;
  constexpr double kLength = 7.9, kLamp = 4.0;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps * kLength, along = kLamp - t;
    const double distance = std::hypot(along, height);
    const double value = phase(static_cast<float>(g), static_cast<float>(along / distance));
    sum += std::exp(-density * (t + distance)) * albedo * density * value / (distance * distance);
  }
  return sum * kLength / kSteps;
}

TEST(Fog, ScattersTheLightOfALampOnceAsAQuadratureSays) {
  // So little albedo that light which is scattered twice does not count.
  for (const double g : {0.0, 0.6}) {
    SceneBuilder builder = dark_hall();
    scene::PunctualLight lamp;
    lamp.position = Vec3(0, 0.25f, -4.1f);
    builder.scene().lights = {lamp};
    RenderOptions options =
        options_of({.density = 0.05f, .albedo = Color::Constant(0.02f), .anisotropy = static_cast<float>(g)});
    const Moments moments = testing::channel_moments(Renderer(builder.scene(), options).render(), 0);
    const double expected = scattered_once(0.05, 0.02, g, 0.25);
    EXPECT_LT(moments.standard_error(), 0.04 * expected) << "lamps nearby are sampled well";
    EXPECT_GT(testing::mean_p_value(moments, expected, 3e-3), 1e-4) << moments.mean() << " " << expected;
  }
}

TEST(Fog, LightSamplesBouncesAndBothAgree) {
  const auto means = [](DirectLight direct, GlassShadows glass) {
    SceneBuilder builder = dark_hall(0.5f);
    // Turned towards the middle of the hall, and a ball of clear glass.
    builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(20.0f))),
                 Vec3(-0.5f, 0.8f, -4.5f), Vec3(1, 0, 0), Vec3(0, 0, 1));
    builder.sphere(builder.material(testing::solid_glass()), Vec3(0.5f, -0.4f, -4), 0.3f, 24, true);
    builder.scene().instances.back().placement = 0;
    RenderOptions options =
        options_of({.density = 0.25f, .albedo = Color(0.9f, 0.8f, 0.7f), .anisotropy = 0.4f});
    options.camera.fov_degrees = 40.0f;
    options.direct = direct;
    options.glass_shadows = glass;
    return testing::means_of_seeds(builder.scene(), options);
  };
  const Moments both = means(DirectLight::mis, GlassShadows::straight);
  for (const DirectLight direct : {DirectLight::nee, DirectLight::bsdf})
    testing::expect_equal_means(both, means(direct, GlassShadows::straight));
}

}  // namespace
}  // namespace gatelight::renderer
