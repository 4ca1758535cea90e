// Samples of lights against their densities.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "renderer/light/lights.h"
#include "renderer/sampling/warp.h"
#include "tests/support/light_scenes.h"
#include "tests/support/materials.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::LitScene;
using testing::PlaneHit;
using testing::Triangle;

constexpr std::size_t kSamplingTests = 64;
constexpr int kSide = 6;  ///< subdivisions of a triangle's edges: 36 cells each

/// Mass that pdf_triangle() puts on each cell of a triangle: a fine midpoint rule over area.
void add_expected(const Lights& lights, const Triangle& t, std::uint32_t instance, std::uint32_t primitive,
                  const Vec3& p, const Vec3& n, std::vector<double>& cells) {
  constexpr int kFine = 24;  // subdivisions of a cell
  constexpr int kTotal = kSide * kFine;
  const Eigen::Vector3d a = t[0].cast<double>();
  const Eigen::Vector3d e1 = t[1].cast<double>() - a;
  const Eigen::Vector3d e2 = t[2].cast<double>() - a;
  const Eigen::Vector3d normal = e1.cross(e2);
  const double area = 0.5 * normal.norm() / (kTotal * kTotal);
  const std::size_t base = cells.size();
  cells.resize(base + kSide * kSide, 0.0);
  for (int i = 0; i < kTotal; ++i) {
    for (int j = 0; j < kTotal - i; ++j) {
      for (int upper = 0; upper < 2; ++upper) {
        if (upper == 1 && i + j == kTotal - 1) continue;
        const double b1 = (i + (upper == 1 ? 2.0 : 1.0) / 3.0) / kTotal;
        const double b2 = (j + (upper == 1 ? 2.0 : 1.0) / 3.0) / kTotal;
        const Eigen::Vector3d to = a + b1 * e1 + b2 * e2 - p.cast<double>();
        const double distance = to.norm();
        const Vec3 wi = (to / distance).cast<float>();
        const double cosine = std::abs(to.dot(normal)) / (distance * normal.norm());
        const auto pdf = static_cast<double>(
            lights.pdf_triangle(p, n, instance, primitive, wi, static_cast<float>(distance)));
        const int x = std::min(static_cast<int>(b1 * kSide), kSide - 1);
        const int y = std::min(static_cast<int>(b2 * kSide), kSide - 1);
        cells[base + static_cast<std::size_t>(x * kSide + y)] += pdf * cosine / (distance * distance) * area;
      }
    }
  }
}

/// Chi-square test of the positions of samples on the triangles (cells of a barycentric grid, and one for "no
/// sample"). Returns the total mass of the densities.
double expect_samples_follow_densities(const LitScene& lit, const Vec3& p, const Vec3& n, std::uint64_t seed,
                                       int samples = 60000) {
  std::vector<Triangle> triangles;
  std::vector<double> expected;
  for (std::uint32_t i = 0; i < lit.scene.instances.size(); ++i) {
    const scene::Instance& instance = lit.scene.instances[i];
    const auto count = static_cast<std::uint32_t>(lit.scene.mesh_of(instance).triangles.size());
    for (std::uint32_t primitive = 0; primitive < count; ++primitive) {
      triangles.push_back(scene::world_triangle(lit.scene, instance, primitive));
      add_expected(lit.lights, triangles.back(), i, primitive, p, n, expected);
    }
  }
  double mass = 0.0;
  for (const double m : expected) mass += m;
  for (double& m : expected) m *= samples;
  expected.push_back(std::max(0.0, 1.0 - mass) * samples);
  if (expected.back() < 1e-3 * samples) expected.back() = 0.0;  // the error of the midpoint rule

  std::vector<double> observed(expected.size(), 0.0);
  testing::Random random(seed);
  for (int s = 0; s < samples; ++s) {
    const LightSample sample = testing::draw_light(lit.lights, p, n, random);
    if (!(sample.pdf > 0.0f)) {
      observed.back() += 1.0;
      continue;
    }
    EXPECT_NEAR(sample.wi.norm(), 1.0f, 1e-5f);
    // The triangle whose plane is met at the sample's distance.
    std::size_t best = 0;
    PlaneHit best_hit;
    double best_error = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const PlaneHit hit = testing::meet(triangles[k], p, sample.wi);
      const double error = std::abs(hit.distance - static_cast<double>(sample.distance));
      if (hit.inside(1e-3) && error < best_error) {
        best = k;
        best_hit = hit;
        best_error = error;
      }
    }
    EXPECT_LT(best_error, 1e-3 * static_cast<double>(sample.distance));
    const int x = std::clamp(static_cast<int>(best_hit.b1 * kSide), 0, kSide - 1);
    const int y = std::clamp(static_cast<int>(best_hit.b2 * kSide), 0, kSide - 1 - x);
    observed[best * kSide * kSide + static_cast<std::size_t>(x * kSide + y)] += 1.0;
  }
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                               testing::sidak(testing::kFamilySignificance, kSamplingTests)));
  return mass;
}

const Triangle kOverhead{Vec3(-1, 2, -1), Vec3(1, 2, -1), Vec3(0, 2, 1)};  // faces down

TEST(LightSamplingTest, ASmallTriangleIsSampledByArea) {
  scene::Scene scene;
  testing::add_light(scene,
                     {{kOverhead[0] * 0.005f + Vec3(0, 2, 0), kOverhead[1] * 0.005f + Vec3(0, 2, 0),
                       kOverhead[2] * 0.005f + Vec3(0, 2, 0)}},
                     Color(1, 1, 1));
  const LitScene lit(std::move(scene));
  const Vec3 p(0.3f, 0.0f, 0.1f);
  EXPECT_NEAR(expect_samples_follow_densities(lit, p, Vec3::UnitY(), 1), 1.0, 1e-3);
  EXPECT_NEAR(expect_samples_follow_densities(lit, Vec3(3.0f, 1.9f, 0.0f), Vec3(-1, 0.1f, 0).normalized(), 2),
              1.0, 1e-3);
}

TEST(LightSamplingTest, ABigTriangleIsSampledBySolidAngle) {
  scene::Scene scene;
  testing::add_light(scene, {kOverhead}, Color(1, 1, 1));
  const LitScene lit(std::move(scene));
  int seed = 10;
  // Far, near, very near above the middle and beside an edge, grazing.
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(0.1f, 1.9f, 0.0f), Vec3(0, 1.6f, 1.2f),
                        Vec3(3, 1.9f, 0.5f), Vec3(20, -30, 10)}) {
    const Vec3 n = (Vec3(0.2f, 2.0f, 0.1f) - p).normalized();
    EXPECT_NEAR(expect_samples_follow_densities(lit, p, n, static_cast<std::uint64_t>(seed++)), 1.0, 2e-3);
    EXPECT_NEAR(expect_samples_follow_densities(lit, p, Vec3::Zero(), static_cast<std::uint64_t>(seed++)),
                1.0, 2e-3);
  }
}

TEST(LightSamplingTest, BothSidesOfATwoSidedTriangleAreSampled) {
  scene::Scene scene;
  testing::add_light(scene, {kOverhead}, Color(1, 1, 1), true);
  const LitScene lit(std::move(scene));
  EXPECT_NEAR(expect_samples_follow_densities(lit, Vec3(0.3f, 0.5f, 0.2f), Vec3::UnitY(), 30), 1.0, 2e-3);
  EXPECT_NEAR(expect_samples_follow_densities(lit, Vec3(0.3f, 3.5f, 0.2f), -Vec3::UnitY(), 31), 1.0, 2e-3);
}

TEST(LightSamplingTest, SamplesOfAQuadFollowTheirDensity) {
  for (const LightSelection selection : {LightSelection::tree, LightSelection::power}) {
    scene::Scene scene;
    testing::add_light(scene, testing::quad(Vec3(-1, 2, -1), Vec3(2, 0, 0), Vec3(0, 0, 2)), Color(3, 2, 1));
    const LitScene lit(std::move(scene), selection);
    EXPECT_NEAR(expect_samples_follow_densities(lit, Vec3(0.5f, 0, 0), Vec3::UnitY(), 40), 1.0, 2e-3);
    EXPECT_NEAR(expect_samples_follow_densities(lit, Vec3(4, 1.5f, 0), Vec3(-1, 0.1f, 0).normalized(), 41),
                1.0, 2e-3);
  }
}

TEST(LightSamplingTest, SamplesOfTrianglesAllAroundFollowTheirDensity) {
  for (const LightSelection selection : {LightSelection::tree, LightSelection::power}) {
    scene::Scene scene;
    testing::Random random(3);
    std::vector<Triangle> triangles;
    const auto vector = [&](double size) {
      return Vec3(static_cast<float>(random.uniform(-size, size)),
                  static_cast<float>(random.uniform(-size, size)),
                  static_cast<float>(random.uniform(-size, size)));
    };
    for (int i = 0; i < 40; ++i) {
      const Vec3 centre = vector(3.0);
      triangles.push_back({centre, centre + vector(0.5), centre + vector(0.5)});
    }
    testing::add_light(scene, {triangles.begin(), triangles.begin() + 20}, Color(1, 1, 1));
    testing::add_light(scene, {triangles.begin() + 20, triangles.end()}, Color(5, 5, 5), true);
    const LitScene lit(std::move(scene), selection);
    expect_samples_follow_densities(lit, Vec3(0, 0, 0), Vec3::UnitY(), 50);
    expect_samples_follow_densities(lit, Vec3(0.5f, -3.2f, 0.2f), Vec3(0.3f, 0.9f, 0.1f).normalized(), 51);
    expect_samples_follow_densities(lit, Vec3(-2, 1, 2), Vec3::Zero(), 52);
  }
}

TEST(LightSamplingTest, AMirroredInstanceShinesFromItsFront) {
  scene::Scene scene;
  testing::add_light(scene, {kOverhead}, Color(1, 1, 1));
  scene.instances[0].baked = false;
  scene.instances[0].swaps_handedness = true;
  scene.instances[0].transform.linear() = Vec3(-1.5f, 1, 1).asDiagonal();
  const LitScene lit(std::move(scene));
  EXPECT_NEAR(expect_samples_follow_densities(lit, Vec3(0.3f, 0.5f, 0.2f), Vec3::UnitY(), 60), 1.0, 2e-3);
  EXPECT_EQ(lit.lights.pdf_triangle(Vec3(0, 4, 0), Vec3::Zero(), 0, 0, -Vec3::UnitY(), 2.0f), 0.0f);
}

TEST(LightSamplingTest, AConstantSkyIsSampledByTheCosine) {
  const LitScene lit(scene::Scene{}, LightSelection::tree, {.constant = Color(1, 1, 1)});
  const Vec3 n = Vec3(0.3f, 0.8f, -0.4f).normalized();
  const Basis basis(n);
  constexpr int kBins = 20;
  constexpr int kSamples = 100000;
  testing::Random random(70);
  std::vector<double> observed(kBins * kBins, 0.0);
  for (int i = 0; i < kSamples; ++i) {
    const LightSample sample = testing::draw_light(lit.lights, Vec3::Zero(), n, random);
    ASSERT_NEAR(sample.pdf, lit.lights.pdf_environment(Vec3::Zero(), n, sample.wi), 1e-5f);
    const float x = basis.tangent.dot(sample.wi);
    const float y = basis.bitangent.dot(sample.wi);
    const double azimuth = std::atan2(y, x) / (2.0 * M_PI) + 0.5;
    const int row = std::clamp(static_cast<int>(n.dot(sample.wi) * kBins), 0, kBins - 1);
    const int column = std::clamp(static_cast<int>(azimuth * kBins), 0, kBins - 1);
    observed[static_cast<std::size_t>(row * kBins + column)] += 1.0;
  }
  std::vector<double> expected;
  for (int row = 0; row < kBins; ++row) {
    const double mass = testing::integrate(
        [&](double z) {
          const auto r = static_cast<float>(std::sqrt(1.0 - z * z));
          return static_cast<double>(lit.lights.pdf_environment(
              Vec3::Zero(), n, basis.to_world(Vec3(r, 0.0f, static_cast<float>(z)))));
        },
        static_cast<double>(row) / kBins, (row + 1.0) / kBins);
    expected.insert(expected.end(), kBins, mass * 2.0 * M_PI / kBins * kSamples);
  }
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                               testing::sidak(testing::kFamilySignificance, kSamplingTests)));
  EXPECT_EQ(lit.lights.pdf_environment(Vec3::Zero(), n, -n), 0.0f);
}

// Everything at once: the shares of tree, sun and sky, and densities that include them.
TEST(LightSamplingTest, SharesOfTreeSunAndSkyAgreeWithTheDensities) {
  scene::Scene scene;
  testing::add_light(scene, {kOverhead}, Color(1, 1, 1));
  scene.lights = {testing::sun(Vec3(0, -1, 0)), testing::sun(Vec3(0, 0.6f, 0.8f))};  // and from below
  const tests::TemporaryFolder folder;
  const LitScene lit(std::move(scene), LightSelection::tree, testing::uniform_picture(folder, 0.5f));
  const Vec3 p = Vec3::Zero();
  struct Case {
    Vec3 n;
    double parts;
  };
  for (const Case& c : {Case{Vec3::UnitY(), 3.0}, Case{Vec3(-Vec3::UnitY()), 2.0}, Case{Vec3::Zero(), 4.0}}) {
    std::vector<double> observed(4, 0.0);  // tree, sky, sun, sun from below
    testing::Random random(80);
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const LightSample sample = testing::draw_light(lit.lights, p, c.n, random);
      ASSERT_GT(sample.pdf, 0.0f);
      if (sample.delta) {
        EXPECT_NEAR(static_cast<double>(sample.pdf), 1.0 / c.parts, 1e-6);
        observed[sample.wi.y() > 0.0f ? 2 : 3] += 1.0;
      } else if (sample.distance == kInfinity) {
        EXPECT_NEAR(sample.pdf / lit.lights.pdf_environment(p, c.n, sample.wi), 1.0f, 1e-3f);
        observed[1] += 1.0;
      } else {
        EXPECT_NEAR(sample.pdf / lit.lights.pdf_triangle(p, c.n, 0, 0, sample.wi, sample.distance), 1.0f,
                    1e-3f);
        observed[0] += 1.0;
      }
    }
    const double share = kSamples / c.parts;
    const bool up = c.n.y() > 0.0f;
    const bool down = c.n.y() < 0.0f;
    const std::vector<double> expected{down ? 0.0 : share, share, down ? 0.0 : share, up ? 0.0 : share};
    EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                                 testing::sidak(testing::kFamilySignificance, kSamplingTests)));
  }
}

TEST(LightSamplingTest, AConstantSkyTakesNoSamplesFromOtherLights) {
  scene::Scene scene;
  scene.lights = {testing::sun(Vec3(0, -1, 0))};
  const LitScene lit(std::move(scene), LightSelection::tree, {.constant = Color(0.5f, 0.5f, 0.5f)});
  const LightSample towards_sun = lit.lights.sample(Vec3::Zero(), Vec3::UnitY(), 0.7f, Vec2(0.3f, 0.6f));
  EXPECT_TRUE(towards_sun.delta);
  EXPECT_EQ(towards_sun.pdf, 1.0f);
  // The density is zero too, or multiple importance sampling would lose the sky.
  EXPECT_EQ(lit.lights.pdf_environment(Vec3::Zero(), Vec3::UnitY(), Vec3(0.6f, 0.8f, 0)), 0.0f);
  // Where the sun is below the horizon only the sky can be sampled.
  EXPECT_EQ(lit.lights.sample(Vec3::Zero(), -Vec3::UnitY(), 0.7f, Vec2(0.3f, 0.6f)).distance, kInfinity);
  EXPECT_GT(lit.lights.pdf_environment(Vec3::Zero(), -Vec3::UnitY(), Vec3(0.6f, -0.8f, 0)), 0.0f);
}

}  // namespace
}  // namespace gatelight::renderer
