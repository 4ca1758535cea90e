// The path tracer against closed forms. Pixels of a picture are independent estimates of the same number
// wherever the scene looks the same in all of them: their mean is compared with it by a t-test.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/render.h"
#include "tests/support/light_scenes.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {

namespace {

using testing::channel_moments;
using testing::Moments;
using testing::SceneBuilder;

const double kPathSignificance = testing::sidak(1e-4, 40);

RenderOptions looking(const Vec3& eye, const Vec3& target, float fov_degrees) {
  RenderOptions options;
  options.width = 24;
  options.height = 24;
  options.spp = 64;
  options.max_depth = 64;
  options.threads = 2;
  LookAt view;
  view.eye = eye;
  view.target = target;
  if ((target - eye).normalized().cwiseAbs().y() > 0.99f) view.up = Vec3(0, 0, -1);
  options.camera.look_at = view;
  options.camera.fov_degrees = fov_degrees;
  return options;
}

void expect_radiance(const scene::Scene& s, const RenderOptions& options, double expected,
                     double rounding = 1e-5) {
  Renderer renderer(s, options);
  const Moments m = channel_moments(renderer.render(), 0);
  EXPECT_GT(testing::mean_p_value(m, expected, rounding), kPathSignificance)
      << "mean " << m.mean() << " +- " << m.standard_error() << ", expected " << expected;
}

class DirectLightModes : public ::testing::TestWithParam<DirectLight> {};

TEST_P(DirectLightModes, ClosedFurnaceShowsEmissionOverOneMinusAlbedo) {
  SceneBuilder builder;
  const int m = builder.material(SceneBuilder::lambert(Color::Constant(0.5f), Color::Constant(1.0f)));
  builder.box(m, Vec3(-2, -1, -3), Vec3(2, 2, 3), true);
  builder.box(m, Vec3(-0.5f, -0.6f, -1), Vec3(0.3f, 0.4f, -0.2f));
  RenderOptions options = looking(Vec3(0.3f, 0.5f, 2.5f), Vec3(0, 0, 0), 70.0f);
  options.direct = GetParam();
  expect_radiance(builder.scene(), options, 2.0);
}

TEST_P(DirectLightModes, DepthCountsScatteringEvents) {
  SceneBuilder builder;
  const int m = builder.material(SceneBuilder::lambert(Color::Constant(0.5f), Color::Constant(1.0f)));
  builder.box(m, Vec3(-1, -1, -1), Vec3(1, 1, 1), true);
  RenderOptions options = looking(Vec3(0, 0, 0.5f), Vec3(0, 0, 0), 60.0f);
  options.direct = GetParam();
  double expected = 1.0;
  double power = 1.0;
  for (int depth = 1; depth <= 3; ++depth) {
    options.max_depth = depth;
    expected += power *= 0.5;
    expect_radiance(builder.scene(), options, expected);
  }
}

TEST_P(DirectLightModes, QuadLightMatchesLambertsFormula) {
  SceneBuilder builder;
  const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(5.0f)));
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.7f)), 10);
  // The front looks down.
  builder.quad(lamp, Vec3(0.5f, 1.5f, -1), Vec3(1, 0, 0), Vec3(0, 0.5f, 2));
  const auto lamp_triangles = testing::quad(Vec3(0.5f, 1.5f, -1), Vec3(1, 0, 0), Vec3(0, 0.5f, 2));
  const double e = 5.0 * testing::triangles_irradiance(lamp_triangles, Vec3::Zero(), Vec3::UnitY());
  // The view is so narrow that every pixel sees the origin.
  RenderOptions options = looking(Vec3(-3, 3, 0), Vec3(0, 0, 0), 0.05f);
  options.direct = GetParam();
  expect_radiance(builder.scene(), options, 0.7 / M_PI * e, 2e-4);
}

INSTANTIATE_TEST_SUITE_P(All, DirectLightModes,
                         ::testing::Values(DirectLight::mis, DirectLight::nee, DirectLight::bsdf));

TEST(PathStat, SphereLightMatchesTheClosedForm) {
  SceneBuilder builder;
  const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(3.0f)));
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.6f)), 10);
  builder.sphere(lamp, Vec3(1, 2, 0), 0.5f, 128, false);
  // Radiance albedo * L * (R/d)^2 * cos; the mesh is inscribed, 128 segments lose 0.1 % of the cross-section.
  const double d2 = 5.0;
  RenderOptions options = looking(Vec3(-3, 3, 0), Vec3(0, 0, 0), 0.05f);
  expect_radiance(builder.scene(), options, 0.6 * 3.0 * 0.25 / d2 * 2.0 / std::sqrt(d2), 2e-3);
}

TEST(PathStat, SunPointAndSpotMatchTheClosedForms) {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.5f)), 10);
  const RenderOptions options = looking(Vec3(-3, 3, 0), Vec3(0, 0, 0), 0.05f);
  builder.scene().lights = {testing::sun(Vec3(0.6f, -0.8f, 0.0f), Color::Constant(4.0f))};
  expect_radiance(builder.scene(), options, 0.5 / M_PI * 4.0 * 0.8, 1e-4);

  scene::PunctualLight light = testing::point_light(Vec3(0, 2, 0), Color::Constant(4.0f));
  builder.scene().lights = {light};
  expect_radiance(builder.scene(), options, 0.5 / M_PI * 4.0 / 4.0, 1e-3);

  light.type = scene::LightType::spot;
  light.direction = Vec3(0, -1, 0);
  builder.scene().lights = {light};
  expect_radiance(builder.scene(), options, 0.5 / M_PI * 4.0 / 4.0, 1e-3);
  light.direction = Vec3(1, 0, 0);
  builder.scene().lights = {light};
  expect_radiance(builder.scene(), options, 0.0, 1e-6);
}

TEST(PathStat, ConvexObjectUnderAConstantSkyShowsAlbedoTimesSky) {
  SceneBuilder builder;
  builder.sphere(builder.material(SceneBuilder::lambert(Color(0.8f, 0.4f, 0.1f))), Vec3(0, 0, 0), 1.0f, 64,
                 false);
  RenderOptions options = looking(Vec3(0, 0, 3), Vec3(0, 0, 0), 20.0f);
  options.environment.constant = Color::Constant(2.0f);
  Renderer renderer(builder.scene(), options);
  const Picture picture = renderer.render();
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected = 2.0 * std::array{0.8, 0.4, 0.1}[c];
    EXPECT_GT(testing::mean_p_value(channel_moments(picture, c), expected, 1e-4), kPathSignificance) << c;
  }
}

TEST(PathStat, VolumeAbsorbsByBeerLambert) {
  // ior 1: no reflection, no refraction. A slab 0.5 m thick, colour 0.25 after 1 m: half the light.
  SceneBuilder builder;
  scene::Material m = testing::solid_glass(1.0f);
  m.attenuation_distance = 1.0f;
  m.attenuation_color = Color(0.25f, 1.0f, 0.25f);
  builder.box(builder.material(m), Vec3(-5, -5, -0.5f), Vec3(5, 5, 0));
  RenderOptions options = looking(Vec3(0, 0, 2), Vec3(0, 0, 0), 0.5f);
  options.environment.constant = Color::Constant(1.0f);
  Renderer renderer(builder.scene(), options);
  const Picture picture = renderer.render();
  // Rays go straight on, so there is no noise.
  EXPECT_NEAR(channel_moments(picture, 0).mean(), 0.5, 1e-3);
  EXPECT_NEAR(channel_moments(picture, 1).mean(), 1.0, 1e-3);
}

TEST(PathStat, PanesPassTheSunToWhatIsBehindThem) {
  // The same floor under the same sun, with and without a pane: the ratio is the pane's transmittance,
  // squared with two panes. A renderer whose shadow rays stop at glass shows black here.
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.5f)), 10);
  scene::Material glass = SceneBuilder::clear_glass();
  testing::add_floor(builder, glass, 1, 1);
  builder.scene().lights = {testing::sun(Vec3(0, -1, 0), Color::Constant(kPi))};
  RenderOptions options = looking(Vec3(-3, 0.5f, 0), Vec3(0, 0, 0), 0.05f);
  options.max_depth = 1;
  Renderer renderer(builder.scene(), options);
  const double mean = channel_moments(renderer.render(), 0).mean();
  EXPECT_GT(mean, 0.5 * 0.91);
  EXPECT_LT(mean, 0.5 * 0.961);
}

TEST(PathStat, PanesAddNoLightOfTheirOwn) {
  // A matte floor and a pane above it in a white furnace: the light that the pane reflects down is missing
  // from the light that it transmits. Shadow rays and BSDF samples through panes must not count the sky
  // twice.
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(1.0f)), 50);
  scene::Material glass = SceneBuilder::clear_glass();
  glass.base_color = Color::Constant(1.0f);
  testing::add_floor(builder, glass, 50, 0.5f);
  RenderOptions options = looking(Vec3(0, 2, 1), Vec3(0, 0, 0), 10.0f);
  options.environment.constant = Color::Constant(1.0f);
  for (DirectLight direct : {DirectLight::mis, DirectLight::nee, DirectLight::bsdf}) {
    options.direct = direct;
    expect_radiance(builder.scene(), options, 1.0);
  }
}

TEST(PathStat, AmbientOcclusionOfADiscMatchesItsFormFactor) {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(1.0f)));
  builder.quad(matte, Vec3(-50, 0, 50), Vec3(100, 0, 0), Vec3(0, 0, -100));
  // A disc of radius 1 at height 0.75: form factor R^2 / (R^2 + h^2) = 0.64.
  PaddedVector<Vec3> points{Vec3(0, 0.75f, 0)};
  std::vector<std::array<std::uint32_t, 3>> fan;
  constexpr std::uint32_t kSegments = 256;
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const float phi = 2.0f * kPi * static_cast<float>(i) / kSegments;
    points.emplace_back(std::cos(phi), 0.75f, std::sin(phi));
    fan.push_back({0, 1 + i, 1 + (i + 1) % kSegments});
  }
  builder.mesh(matte, points, fan);
  RenderOptions options = looking(Vec3(-3, 0.4f, 0), Vec3(0, 0, 0), 0.02f);
  options.integrator = Integrator::ao;
  options.ao_distance = kInfinity;
  expect_radiance(builder.scene(), options, 0.36, 2e-3);
  options.ao_distance = 0.7f;
  expect_radiance(builder.scene(), options, 1.0);
}

}  // namespace
}  // namespace gatelight::renderer
