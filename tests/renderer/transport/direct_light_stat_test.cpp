// Irradiance by sampling lights against closed forms, occlusion left out.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "renderer/light/lights.h"
#include "renderer/sampling/warp.h"
#include "tests/support/light_scenes.h"
#include "tests/support/materials.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::LitScene;
using testing::Moments;
using testing::Triangle;

constexpr double kFamily = 1e-5;
constexpr std::size_t kTests = 64;

Moments irradiance(const Lights& lights, const Vec3& p, const Vec3& n, int samples, std::uint64_t seed) {
  Moments moments;
  testing::Random random(seed);
  for (int i = 0; i < samples; ++i) {
    const LightSample sample = testing::draw_light(lights, p, n, random);
    const float value =
        sample.pdf > 0.0f ? sample.radiance.x() * std::max(0.0f, n.dot(sample.wi)) / sample.pdf : 0.0f;
    EXPECT_TRUE(std::isfinite(value));
    moments.add(static_cast<double>(value));
  }
  return moments;
}

void expect_irradiance(const Lights& lights, const Vec3& p, const Vec3& n, double expected,
                       std::uint64_t seed, int samples = 20000) {
  const Moments moments = irradiance(lights, p, n, samples, seed);
  EXPECT_GE(testing::mean_p_value(moments, expected, 1e-4), testing::sidak(kFamily, kTests))
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

Vec3 tilted(float degrees) {
  const float angle = degrees * kPi / 180.0f;
  return {std::sin(angle), std::cos(angle), 0.0f};
}

/// A sphere of triangles that all have its own area in sum, so that by Cauchy's theorem its mean shadow is
/// the sphere's too.
std::vector<Triangle> sphere(const Vec3& centre, float radius, int subdivisions) {
  std::vector<Triangle> triangles;
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 x = Vec3::UnitX() * (octant & 1 ? -1.0f : 1.0f);
    const Vec3 y = Vec3::UnitY() * (octant & 2 ? -1.0f : 1.0f);
    const Vec3 z = Vec3::UnitZ() * (octant & 4 ? -1.0f : 1.0f);
    const bool flip = ((octant & 1) + (octant >> 1 & 1) + (octant >> 2 & 1)) % 2 == 1;
    triangles.push_back(flip ? Triangle{x, z, y} : Triangle{x, y, z});
  }
  for (int i = 0; i < subdivisions; ++i) {
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 ab = (a + b).normalized();
      const Vec3 bc = (b + c).normalized();
      const Vec3 ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  double area = 0.0;
  for (const auto& [a, b, c] : triangles) area += 0.5 * static_cast<double>((b - a).cross(c - a).norm());
  const float scale = radius * static_cast<float>(std::sqrt(4.0 * M_PI / area));
  for (Triangle& t : triangles) {
    for (Vec3& corner : t) corner = centre + scale * corner;
  }
  return triangles;
}

TEST(DirectLightTest, QuadAgreesWithLambertsFormula) {
  const std::vector<Triangle> triangles = testing::quad(Vec3(-1, 2, -1), Vec3(2, 0, 0), Vec3(0, 0, 2));
  for (const LightSelection selection : {LightSelection::tree, LightSelection::power}) {
    scene::Scene scene;
    testing::add_light(scene, triangles, Color(3, 3, 3));
    const LitScene lit(std::move(scene), selection);
    std::uint64_t seed = 1;
    for (const float degrees : {0.0f, 45.0f, 80.0f, 95.0f, 110.0f}) {  // the last two are cut by the horizon
      const Vec3 n = tilted(degrees);
      for (const Vec3& p : {Vec3(0, 0, 0), Vec3(-1.5f, 1.5f, 0.5f), Vec3(-0.5f, 1.99f, 0.1f)}) {
        expect_irradiance(lit.lights, p, n, 3.0 * testing::triangles_irradiance(triangles, p, n), seed++);
      }
    }
  }
}

TEST(DirectLightTest, SphereAgreesWithTheInverseSquare) {
  scene::Scene scene;
  testing::add_light(scene, sphere(Vec3(0, 3, 0), 1.0f, 4), Color(2, 2, 2));
  const LitScene lit(std::move(scene));
  std::uint64_t seed = 100;
  for (const float degrees : {0.0f, 30.0f, 60.0f}) {
    const double expected = 2.0 * M_PI / 9.0 * std::cos(static_cast<double>(degrees) * M_PI / 180.0);
    expect_irradiance(lit.lights, Vec3::Zero(), tilted(degrees), expected, seed++, 40000);
  }
}

TEST(DirectLightTest, DiskAgreesWithItsClosedForm) {
  constexpr int kSegments = 256;
  // The polygon that has the disk's area.
  const double radius = std::sqrt(2.0 * M_PI / (kSegments * std::sin(2.0 * M_PI / kSegments)));
  std::vector<Triangle> fan;
  const auto rim = [&](int i) {
    const double angle = 2.0 * M_PI * i / kSegments;
    return Vec3(static_cast<float>(radius * std::cos(angle)), 1.5f,
                static_cast<float>(radius * std::sin(angle)));
  };
  for (int i = 0; i < kSegments; ++i) fan.push_back({Vec3(0, 1.5f, 0), rim(i), rim(i + 1)});
  scene::Scene scene;
  testing::add_light(scene, fan, Color(1, 1, 1));
  const LitScene lit(std::move(scene));
  std::uint64_t seed = 200;
  for (const float degrees : {0.0f, 30.0f, 55.0f}) {
    const double expected = M_PI / (1.0 + 1.5 * 1.5) * std::cos(static_cast<double>(degrees) * M_PI / 180.0);
    expect_irradiance(lit.lights, Vec3::Zero(), tilted(degrees), expected, seed++, 40000);
  }
}

TEST(DirectLightTest, SunAndConstantSkyAreExact) {
  scene::Scene scene;
  scene.lights = {testing::sun(Vec3(0, -1, 0), Color(4, 4, 4))};
  const LitScene lit(std::move(scene));
  const LitScene sky(scene::Scene{}, LightSelection::tree, {.constant = Color(1, 1, 1), .scale = 0.5f});
  for (const float degrees : {0.0f, 30.0f, 85.0f}) {
    const double cosine = std::cos(static_cast<double>(degrees) * M_PI / 180.0);
    const Moments from_sun = irradiance(lit.lights, Vec3(1, 2, 3), tilted(degrees), 50, 300);
    EXPECT_NEAR(from_sun.mean(), 4.0 * cosine, 1e-5);
    EXPECT_LT(from_sun.variance(), 1e-9);
    const Moments from_sky = irradiance(sky.lights, Vec3(1, 2, 3), tilted(degrees), 50, 301);
    EXPECT_NEAR(from_sky.mean(), 0.5 * M_PI, 1e-4);
    EXPECT_LT(from_sky.variance(), 1e-6);
  }
  EXPECT_EQ(irradiance(lit.lights, Vec3::Zero(), -Vec3::UnitY(), 50, 302).mean(), 0.0);
}

TEST(DirectLightTest, SunSkyAndLampsAddUp) {
  const std::vector<Triangle> triangles = testing::quad(Vec3(-1, 2, -1), Vec3(2, 0, 0), Vec3(0, 0, 2));
  scene::Scene scene;
  testing::add_light(scene, triangles, Color(3, 3, 3));
  scene.lights = {testing::sun(Vec3(0, -1, 0), Color(2, 2, 2)),
                  testing::point_light(Vec3(0, 1, 0), Color(2, 2, 2))};
  const tests::TemporaryFolder folder;
  const LitScene lit(std::move(scene), LightSelection::tree, testing::uniform_picture(folder, 1.0f));
  const Vec3 n = tilted(20.0f);
  const double expected = 3.0 * testing::triangles_irradiance(triangles, Vec3::Zero(), n) +
                          4.0 * static_cast<double>(n.y()) + M_PI;
  expect_irradiance(lit.lights, Vec3::Zero(), n, expected, 400);
}

TEST(DirectLightTest, PointAndSpotHaveTheExtensionsFalloff) {
  scene::Scene scene;
  scene::PunctualLight light = testing::point_light(Vec3(0, 2, 0), Color(10, 5, 1));
  light.range = 4.0f;
  scene.lights = {light};
  const LitScene point(std::move(scene));
  LightSample sample = point.lights.sample(Vec3::Zero(), Vec3::UnitY(), 0.5f, Vec2(0.5f, 0.5f));
  EXPECT_TRUE(sample.delta);
  EXPECT_FLOAT_EQ(sample.pdf, 1.0f);
  EXPECT_FLOAT_EQ(sample.distance, 2.0f);
  EXPECT_NEAR(sample.radiance.x(), 10.0f / 4.0f * (1.0f - 1.0f / 16.0f), 1e-5f);
  EXPECT_NEAR(sample.radiance.z(), 1.0f / 4.0f * (1.0f - 1.0f / 16.0f), 1e-5f);
  EXPECT_TRUE(
      (point.lights.sample(Vec3(0, -2.001f, 0), Vec3::UnitY(), 0.5f, Vec2::Zero()).radiance == 0.0f).all());

  scene::Scene spots;
  light.type = scene::LightType::spot;
  light.range = kInfinity;
  light.direction = Vec3(0, -1, 0);
  light.cos_inner = 0.9f;
  light.cos_outer = 0.7f;
  spots.lights = {light};
  const LitScene spot(std::move(spots));
  for (const float cosine : {1.0f, 0.95f, 0.85f, 0.75f, 0.69f, 0.3f}) {
    const float sine = std::sqrt(1.0f - cosine * cosine);
    const Vec3 p = light.position + 3.0f * Vec3(sine, -cosine, 0.0f);
    sample = spot.lights.sample(p, Vec3::UnitY(), 0.5f, Vec2(0.5f, 0.5f));
    const float falloff = std::clamp((cosine - 0.7f) / 0.2f, 0.0f, 1.0f);
    EXPECT_NEAR(sample.radiance.x(), 10.0f / 9.0f * falloff * falloff, 1e-4f) << cosine;
  }
}

// 2000 small one-sided lamps in a room, receivers on its floor and in its middle: the tree's mean agrees with
// the closed form, the power table's too, and the tree's variance is far lower.
TEST(DirectLightTest, TheTreeIsUnbiasedAndBeatsPowerByFar) {
  testing::Random random(8);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 centre(10.0f * random.uniform_float(), 10.0f * random.uniform_float(),
                      10.0f * random.uniform_float());
    const Basis basis(sample_uniform_sphere(testing::next_2d(random)));
    triangles.push_back({centre, centre + 0.05f * basis.tangent, centre + 0.05f * basis.bitangent});
  }
  scene::Scene scene;
  testing::add_light(scene, triangles, Color(1, 1, 1));
  const LitScene tree(scene, LightSelection::tree);
  const LitScene power(scene, LightSelection::power);
  EXPECT_EQ(tree.lights.emissive_triangles(), 2000u);
  double log_ratio = 0.0;
  const std::array<std::pair<Vec3, Vec3>, 6> receivers{{{Vec3(5, 0, 5), Vec3(0, 1, 0)},
                                                        {Vec3(1, 0, 9), Vec3(0, 1, 0)},
                                                        {Vec3(5, 5, 5), Vec3(0, 1, 0)},
                                                        {Vec3(2, 7, 3), Vec3(0.6f, -0.8f, 0)},
                                                        {Vec3(0, 3, 4), Vec3(1, 0, 0)},
                                                        {Vec3(8, 1, 6), Vec3(0, 0, 1)}}};
  std::uint64_t seed = 500;
  for (const auto& [p, n] : receivers) {
    const double expected = testing::triangles_irradiance(triangles, p, n);
    const Moments by_tree = irradiance(tree.lights, p, n, 40000, seed++);
    const Moments by_power = irradiance(power.lights, p, n, 40000, seed++);
    EXPECT_GE(testing::mean_p_value(by_tree, expected), testing::sidak(kFamily, kTests));
    // Its distribution has a heavy tail, which a t-test of this many samples does not bear: five standard
    // errors of the true variance would be as wide.
    EXPECT_NEAR(by_power.mean(), expected, 0.2 * expected);
    log_ratio += std::log(by_power.variance() / by_tree.variance()) / receivers.size();
  }
  RecordProperty("variance_ratio", std::to_string(std::exp(log_ratio)));
  EXPECT_GT(std::exp(log_ratio), 3.0);
}

}  // namespace
}  // namespace gatelight::renderer
