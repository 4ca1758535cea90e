// Light that passes solid glass unrefracted: closed forms of shadow rays, and light samples, bounces and both
// agree.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/render.h"
#include "renderer/transport/world.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"
#include "tests/support/shadow_rays.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {

namespace {

using testing::Moments;
using testing::SceneBuilder;

/// Glass of index 1.5, tinted by a coloured inside.
scene::Material green_glass(float roughness = 0.0f) {
  scene::Material m = testing::solid_glass(1.5f, roughness);
  m.attenuation_distance = 0.5f;
  m.attenuation_color = Color(0.4f, 0.9f, 0.6f);
  return m;
}

/// A block of glass 0.25 m thick, across the z axis.
SceneBuilder block_of_glass() {
  SceneBuilder builder;
  builder.box(builder.material(green_glass()), Vec3(-4, -4, 0), Vec3(4, 4, 0.25f));
  return builder;
}

constexpr float kNormalFresnel = 0.04f;

Color absorbed(float distance) {
  const scene::Material m = green_glass();
  return m.attenuation_color.pow(distance / m.attenuation_distance);
}

/// Transmittance of a shadow ray of this length along -z, from height z.
Color passed(float z, float length, GlassShadows glass = GlassShadows::straight) {
  SceneBuilder builder = block_of_glass();
  const World world(builder.scene(), {.glass_shadows = glass});
  return testing::passed_down(world, z, length);
}

TEST(UnrefractedGlass, ShadowRaysAreAttenuatedByBoundariesAndInside) {
  const float boundary = 1.0f - kNormalFresnel;
  EXPECT_TRUE(passed(1.0f, 2.0f).isApprox(boundary * boundary * absorbed(0.25f), 1e-4f)) << "through";
  EXPECT_TRUE(passed(1.0f, kInfinity).isApprox(boundary * boundary * absorbed(0.25f), 1e-4f)) << "to a sun";
  EXPECT_TRUE(passed(0.2f, 2.0f).isApprox(boundary * absorbed(0.2f), 1e-4f)) << "from inside";
  EXPECT_TRUE(passed(1.0f, 0.9f).isApprox(boundary * absorbed(0.15f), 1e-4f)) << "to a light inside";
  EXPECT_TRUE((passed(1.0f, 0.5f) == 1.0f).all()) << "before it";
  EXPECT_TRUE((passed(1.0f, 2.0f, GlassShadows::refract) == 0.0f).all());
}

TEST(UnrefractedGlass, TheSunReachesTheGroundUnderABlock) {
  SceneBuilder builder = block_of_glass();
  builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(-4, -4, -1),
               Vec3(8, 0, 0), Vec3(0, 8, 0));
  builder.scene().lights = {testing::sun(Vec3(0, 0, -1))};
  RenderOptions options;
  options.width = options.height = 8;
  options.spp = 4;
  options.max_depth = 1;
  // The view is from below the glass.
  options.camera.look_at = LookAt{Vec3(0.3f, 0.2f, -0.5f), Vec3(0.3f, 0.2f, -1.0f), Vec3(0, 1, 0)};
  options.glass_shadows = GlassShadows::straight;
  const Picture picture = Renderer(builder.scene(), options).render();
  const Color expected = absorbed(0.25f) * ((1.0f - kNormalFresnel) * (1.0f - kNormalFresnel) * 0.5f / kPi);
  for (std::size_t i = 0; i < picture.layers[0].values.size(); ++i) {
    ASSERT_NEAR(picture.layers[0].values[i], expected[static_cast<Eigen::Index>(i % 3)], 1e-4f);
  }
}

/// Means of pictures with seeds of their own: a floor under a ball of glass and a lamp, in a dim sky.
/// `filled`: a ball of water, its floor and a sheet of glass are in it.
Moments means(const scene::Material& glass, DirectLight direct, bool filled = false) {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.6f)), 3);
  builder.sphere(builder.material(glass), Vec3(0, 0.8f, 0), 0.5f, 24, true);
  if (filled) {
    builder.scene().instances.back().placement = 0;
    scene::Material water = glass;
    water.ior = 1.33f;
    water.attenuation_color = Color(0.9f, 0.5f, 0.3f);
    builder.sphere(builder.material(water), Vec3(0.1f, 0.75f, 0), 0.35f, 24, true);
    builder.scene().instances.back().placement = 1;
    testing::add_floor(builder, glass, 0.2f, 0.8f);
    testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.6f)), 0.2f, 0.6f);
  }
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(6.0f))),
               Vec3(-0.7f, 2.2f, -0.7f), Vec3(1.4f, 0, 0), Vec3(0, 0, 1.4f));
  RenderOptions options;
  options.width = options.height = 16;
  options.spp = 64;
  options.max_depth = 4;
  options.direct = direct;
  options.glass_shadows = GlassShadows::straight;
  options.environment.constant = Color::Constant(0.2f);
  options.camera.look_at = LookAt{Vec3(0, 1.2f, 3), Vec3(0, 0.3f, 0), Vec3(0, 1, 0)};
  return testing::means_of_seeds(builder.scene(), options);
}

TEST(UnrefractedGlass, LightSamplesBouncesAndBothAgree) {
  struct Case {
    float roughness;
    bool filled;
  };
  for (const Case& c : {Case{0.0f, false}, Case{0.4f, false}, Case{0.0f, true}}) {
    SCOPED_TRACE(::testing::Message() << c.roughness << (c.filled ? ", filled with water" : ""));
    const Moments both = means(green_glass(c.roughness), DirectLight::mis, c.filled);
    for (const DirectLight direct : {DirectLight::nee, DirectLight::bsdf}) {
      // nee leaves out lamps that are visible only by refraction, so rough glass is compared by bounces.
      if (direct == DirectLight::nee && c.roughness > 0.0f) continue;
      testing::expect_equal_means(both, means(green_glass(c.roughness), direct, c.filled));
    }
  }
}

double white_ball(std::uint32_t seed) {
  SceneBuilder builder;
  builder.sphere(builder.material(testing::solid_glass()), Vec3(0, 0, 0), 0.5f, 24, true);
  testing::add_floor(builder, SceneBuilder::lambert(Color::Ones()), 9, -0.6f);
  RenderOptions options;
  options.width = options.height = 16;
  options.spp = 64;
  options.seed = seed;
  options.max_depth = 256;
  options.min_depth = 256;
  options.glass_shadows = GlassShadows::straight;
  options.environment.constant = Color::Ones();
  options.camera.look_at = LookAt{Vec3(0, 1, 2), Vec3(0, -0.3f, 0), Vec3(0, 1, 0)};
  return testing::moments_of(Renderer(builder.scene(), options).render()).mean();
}

TEST(UnrefractedGlass, AWhiteBallInAFurnaceStaysWhite) {
  constexpr testing::MeasuredError kError = {-0.0041, 0.0008, 32};  // measured with the seeds 1 to 32
  const double mean = white_ball(0);
  EXPECT_GT(testing::MeasuredErrors().p_value(mean, 1.0, kError), 1e-4) << mean;
}

}  // namespace
}  // namespace gatelight::renderer
