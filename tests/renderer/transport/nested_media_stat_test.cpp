// Bodies of glass and water that overlap or lie inside one another: closed forms of their transmittance.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/render.h"
#include "renderer/surface/surroundings.h"
#include "renderer/transport/world.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"
#include "tests/support/shadow_rays.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {
using testing::channel_moments;
using testing::Moments;
using testing::SceneBuilder;

// Of the means of this file.
const double kMediaSignificance = testing::sidak(1e-4, 16);

constexpr float kWater = 1.33f, kGlass = 1.5f;

void expect_media_mean(const Moments& moments, double expected) {
  EXPECT_GT(testing::mean_p_value(moments, expected, 1e-5), kMediaSignificance)
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

/// Slabs across the z axis, before a lamp of radiance 1.
struct Stack : SceneBuilder {
  RenderOptions options;

  Stack() {
    scene::Material lamp = lambert(Color::Zero(), Color::Ones());
    quad(material(lamp), Vec3(-50, -50, -1), Vec3(100, 0, 0), Vec3(0, 100, 0));
    options.width = options.height = 16;
    options.spp = 156;
    options.max_depth = options.min_depth = 100;
    options.camera.look_at =
        LookAt{.eye = Vec3(0.1f, 0.2f, 10), .target = Vec3(0.1f, 0.2f, 0), .up = Vec3(0, 1, 0)};
    options.camera.fov_degrees = 0.2f;
  }
  scene::Instance& slab(float ior, float low, float high, const Color& absorption = Color::Zero()) {
    scene::Material m = testing::solid_glass(ior);
    m.attenuation_distance = 1.0f;
    m.attenuation_color = (-absorption).exp();
    // Wide ones: light that leaves by the sides is lost.
    box(material(m), Vec3(-40, -40, low), Vec3(40, 40, high));
    scene::Instance& instance = scene().instances.back();
    instance.placement = static_cast<int>(scene().instances.size());
    return instance;
  }
  Picture picture() { return Renderer(scene(), options).render(); }
  /// Light without noise.
  Color exact_light() {
    const std::vector<float> v = picture().layers[0].values;
    return {v[0], v[1], v[2]};
  }
  void expect_light(double expected) { expect_media_mean(channel_moments(picture(), 1), expected); }
};

/// Fresnel's reflectance at normal incidence, over the transmittance. These add up in a stack of plates whose
/// light does not interfere: the transmittance is 1 / (1 + sum) (Stokes 1862).
double plate(float a, float b) {
  const double r = std::pow((static_cast<double>(a) - b) / (static_cast<double>(a) + b), 2.0);
  return r / (1.0 - r);
}

TEST(NestedMedia, ABlockInWaterHasTheIndexOfBoth) {
  Stack stack;
  stack.slab(kWater, 0, 3);
  stack.slab(kGlass, 1, 2);
  const double expected = 1.0 / (1.0 + 2.0 * plate(1, kWater) + 2.0 * plate(kWater, kGlass));
  stack.expect_light(expected);
}

TEST(NestedMedia, TheSameMediumInsideIsInvisible) {
  Stack stack;
  stack.slab(kWater, 0, 3);
  stack.slab(kWater, 1, 2);
  stack.expect_light(1.0 / (1.0 + 2.0 * plate(1, kWater)));
}

TEST(NestedMedia, OverlappingBlocksHaveOneBoundaryBetweenThem) {
  const double expected = 1.0 / (1.0 + plate(1, kWater) + plate(kWater, kGlass) + plate(kGlass, 1));
  for (const float priority : {0.0f, 1.0f}) {
    Stack stack;
    stack.slab(kWater, 0, 3).dielectric_priority = priority;
    stack.slab(kGlass, 2, 4);
    SCOPED_TRACE(priority);
    stack.expect_light(expected);
  }
}

TEST(NestedMedia, OnlyTheStrongerMediumAbsorbsWhereTheyOverlap) {
  const Color red(0.5f, 0.0f, 0.0f), green(0.0f, 0.5f, 0.0f);
  for (const float priority : {0.0f, 1.0f}) {
    Stack stack;
    stack.options.spp = 4;
    stack.slab(1.0f, 0, 2, red);
    stack.slab(1.0f, 1, 3, green).dielectric_priority = priority;
    const Color passed = stack.exact_light();
    EXPECT_NEAR(passed[0], std::exp(-0.5f * (2.0f - priority)), 1e-4f) << priority;
    EXPECT_NEAR(passed[1], std::exp(-0.5f * (1.0f + priority)), 1e-4f) << priority;
    EXPECT_NEAR(passed[2], 1.0f, 1e-4f);
  }
}

TEST(NestedMedia, LeavingTheInnerMediumDoesNotLeaveTheOuterOne) {
  Stack stack;
  stack.options.spp = 4;
  stack.slab(1.0f, 0, 3, Color(0.5f, 0.0f, 0.0f));
  stack.slab(1.0f, 1, 2, Color(0.0f, 0.5f, 0.0f));
  const Color passed = stack.exact_light();
  EXPECT_NEAR(passed[0], std::exp(-1.0f), 1e-4f);
  EXPECT_NEAR(passed[1], std::exp(-0.5f), 1e-4f);
}

TEST(NestedMedia, ACameraInTheWaterStartsInItsMedium) {
  Stack stack;
  stack.slab(kWater, 0, 20);
  stack.slab(kGlass, 1, 2);
  // The lamp's light through three boundaries, and the part of the rest that the surface behind the camera
  // reflects.
  const double passed = 1.0 / (1.0 + 2.0 * plate(kWater, kGlass) + plate(kWater, 1));
  const double behind = 1.0 - 1.0 / (1.0 + plate(1, kWater));
  const double expected = static_cast<double>(kWater * kWater) * passed / (1.0 - (1.0 - passed) * behind);
  stack.expect_light(expected);

  // A smooth ball in the way of the ray that looks for the water's surface.
  stack.sphere(stack.material(SceneBuilder::lambert(Color::Ones())),
               Vec3(0, 0, 10) + 3.0f * Vec3(0.48f, 0.64f, 0.6f), 1.0f, 96, true);
  const World world(stack.scene());
  const Surroundings around(world.scene, world.media, world.accel, world.surfaces, world.scene.bounds);
  const auto volumes = [&](float z) { return around.at(Vec3(0, 0, z), scene::kShutterMiddle).volumes; };
  EXPECT_EQ(volumes(10).strongest(), 1u);
  EXPECT_EQ(volumes(1.5f).strongest(), 0u);
  EXPECT_EQ(volumes(1.5f).strongest_but(0), 1u);
  EXPECT_EQ(volumes(30).strongest(), scene::kNoVolume);
}

TEST(NestedMedia, ShadowRaysPassMediaInTheirOrder) {
  Stack stack;
  stack.slab(kWater, 0, 3, Color(0.2f, 0.0f, 0.0f));
  stack.slab(kGlass, 1, 2, Color(0.0f, 0.3f, 0.0f));
  stack.slab(kWater, 1.2f, 1.6f, Color(0.0f, 0.0f, 5.0f)).dielectric_priority = -1.0f;
  const World world(stack.scene(), {.glass_shadows = GlassShadows::straight});
  const auto passed = [&](float z, float length) { return testing::passed_down(world, z, length); };
  const auto through = [](double a, double b) { return static_cast<float>(1.0 / (1.0 + plate(a, b))); };
  const float water = through(1, kWater), glass = through(kWater, kGlass);
  // The weakest slab has no effect.
  const Color all(water * water * glass * glass * std::exp(-0.4f),
                  water * water * glass * glass * std::exp(-0.3f), water * water * glass * glass);
  EXPECT_TRUE(passed(10.0f, 10.5f).isApprox(all, 1e-4f)) << passed(10.0f, 10.5f);
  const Color from_inside(water * glass * std::exp(-0.2f), water * glass * std::exp(-0.15f), water * glass);
  EXPECT_TRUE(passed(1.5f, 2.0f).isApprox(from_inside, 1e-4f)) << passed(1.5f, 2.0f);
  const Color to_inside(water * glass * std::exp(-0.2f), water * glass * std::exp(-0.15f), water * glass);
  EXPECT_TRUE(passed(10.0f, 8.5f).isApprox(to_inside, 1e-4f)) << passed(10.0f, 8.5f);
}

TEST(NestedMedia, LightSamplesAreDimmedInTheWater) {
  // A lamp and a sheet in tinted water, seen from within it: light samples and bounces agree.
  const auto seen = [](DirectLight direct) {
    SceneBuilder builder;
    scene::Material water = testing::solid_glass(kWater);
    water.attenuation_distance = 1.0f;
    water.attenuation_color = Color(0.3f, 0.6f, 0.9f);
    const auto body = [&](const Vec3& low, const Vec3& high) {
      builder.box(builder.material(water), low, high);
      builder.scene().instances.back().placement = static_cast<int>(builder.scene().instances.size());
    };
    body(Vec3(-9, -9, -9), Vec3(9, 9, 9));
    body(Vec3(8, 8, 8), Vec3(10, 10, 10));  // so that they are listed
    builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.8f))), Vec3(-1, -1, -1),
                 Vec3(2, 0, 0), Vec3(0, 2, 0));
    builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(9.0f))),
                 Vec3(2, -1, -1), Vec3(0, 0, 1), Vec3(0, 2, 0));
    builder.scene().materials.back().double_sided = true;
    RenderOptions options;
    options.width = options.height = 8;
    options.spp = 4096;
    options.max_depth = 1;
    options.direct = direct;
    options.camera.look_at = LookAt{.eye = Vec3(0, 0, 2), .target = Vec3::Zero(), .up = Vec3(0, 1, 0)};
    options.camera.fov_degrees = 20.0f;
    return Renderer(builder.scene(), options).render();
  };
  const Picture samples = seen(DirectLight::nee), bounces = seen(DirectLight::bsdf);
  EXPECT_GT(channel_moments(samples, 0).mean(), 1e-4);
  EXPECT_LT(channel_moments(samples, 0).mean(), 0.3 * channel_moments(samples, 2).mean())
      << "the water is blue";
  for (std::size_t c = 0; c < 3; ++c) {
    // A paired test: each pixel sees another part of the sheet, but the same part in both pictures.
    Moments differences;
    for (std::size_t i = c; i < samples.layers[0].values.size(); i += 3)
      differences.add(static_cast<double>(bounces.layers[0].values[i] - samples.layers[0].values[i]));
    expect_media_mean(differences, 0.0);
  }
}

TEST(NestedMedia, RoughIceThatOverlapsWaterLosesNoLight) {
  // The index of ice is so near to that of water that light between them is unrefracted; in a white furnace
  // each path has a radiance of 1.
  Stack stack;
  stack.slab(1.333f, 0, 3);
  stack.slab(1.31f, 2, 4);
  for (std::size_t i = 1; i < 3; ++i) stack.scene().materials[i].roughness = 0.1f;
  stack.scene().materials[0].emission.setZero();
  stack.scene().materials[0].base_color.setOnes();
  stack.options.environment.constant = Color::Ones();
  stack.options.spp = 16;
  stack.expect_light(1.0);
}

TEST(NestedMedia, ABlockOfAirInDispersingGlassIsColourlessAtNormalIncidence) {
  // A block of air in dispersing glass, like a prism: at normal incidence light is only reduced by the
  // reflections of its boundaries.
  Stack stack;
  stack.slab(kGlass, 0, 3);
  stack.slab(1.0f, 1, 2);
  stack.scene().materials[1].dispersion = 1.0f;
  const Picture picture = stack.picture();
  const double expected = 1.0 / (1.0 + 4.0 * plate(1, kGlass));
  for (std::size_t c = 0; c < 3; ++c) expect_media_mean(channel_moments(picture, c), expected);
}

/// Balls of water, glass and ice, smooth and rough, in a white sky: nothing absorbs, so all are invisible.
TEST(NestedMedia, BallsInAWhiteFurnaceAreInvisible) {
  for (const float roughness : {0.0f, 0.3f}) {
    SceneBuilder builder;
    const auto ball = [&](float ior, const Vec3& center, float radius) {
      builder.sphere(builder.material(testing::solid_glass(ior, roughness)), center, radius, 48, true);
      builder.scene().instances.back().placement = static_cast<int>(builder.scene().instances.size());
    };
    ball(kWater, Vec3(0, 0, 0), 1.0f);
    ball(kGlass, Vec3(0.7f, 0, 0), 0.6f);
    ball(1.0f, Vec3(-0.4f, 0.2f, 0), 0.3f);
    ball(1.31f, Vec3(-0.1f, -0.4f, 0.2f), 0.4f);
    RenderOptions options;
    options.width = options.height = 16;
    options.spp = 256;
    options.max_depth = options.min_depth = 500;
    options.environment.constant = Color::Ones();
    options.camera.look_at = LookAt{.eye = Vec3(0, 0.5f, 4), .target = Vec3::Zero(), .up = Vec3(0, 1, 0)};
    SCOPED_TRACE(roughness);
    expect_media_mean(channel_moments(Renderer(builder.scene(), options).render(), 1), 1.0);
  }
}

}  // namespace
}  // namespace gatelight::renderer
