#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/renderer/bsdf_cases.h"
#include "tests/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Random;

constexpr int kThetas = 24;
constexpr int kPhis = 24;
constexpr double kTurn = 2.0 * 3.14159265358979323846;

std::size_t cell_of(const Vec3& wi) {
  const double theta = std::atan2(std::hypot(wi.x(), wi.y()), wi.z());
  const double phi = std::atan2(wi.y(), wi.x());
  const int i = std::min(static_cast<int>(theta / (kTurn / 2.0) * kThetas), kThetas - 1);
  const int j = std::min(static_cast<int>((phi < 0.0 ? phi + kTurn : phi) / kTurn * kPhis), kPhis - 1);
  return static_cast<std::size_t>(i * kPhis + j);
}

/// The density integrated over the cells; a plane of symmetry through wo saves half of the work. Grazing
/// lobes are narrow opposite to wo and just above and below the horizon, so those cells get more steps.
std::vector<double> integrate_cells(const Bsdf& bsdf, int steps) {
  std::vector<double> cells(kThetas * kPhis);
  for (int i = 0; i < kThetas; ++i) {
    for (int j = 0; j < kPhis / 2; ++j) {
      const double theta = kTurn / 2.0 / kThetas;
      const double phi = kTurn / kPhis;
      const bool horizon = i == kThetas / 2 - 1 || i == kThetas / 2;
      const int theta_steps = horizon ? 6 * steps : steps;
      const int phi_steps = j == kPhis / 2 - 1 ? 12 * steps : steps;
      const double mass = testing::integrate(
          [&](double t) {
            const double sine = std::sin(t);
            return sine * testing::integrate(
                              [&](double p) {
                                const Vec3 wi(static_cast<float>(sine * std::cos(p)),
                                              static_cast<float>(sine * std::sin(p)),
                                              static_cast<float>(std::cos(t)));
                                return static_cast<double>(bsdf.evaluate(wi).pdf);
                              },
                              phi * j, phi * (j + 1), phi_steps);
          },
          theta * i, theta * (i + 1), theta_steps);
      cells[i * kPhis + j] = mass;
      cells[i * kPhis + kPhis - 1 - j] = mass;
    }
  }
  return cells;
}

TEST(BsdfSampling, SamplesFollowTheDensity) {
  constexpr int kSamples = 60000;
  std::vector<BsdfCase> cases = colored_cases();
  std::erase_if(cases, [](const BsdfCase& c) { return c.name == "ior 0" || c.name == "ior 3"; });
  const std::array<float, 3> roughnesses{0.25f, 0.5f, 1.0f};
  const std::array<float, 3> cosines{1.0f, 0.5f, 0.02f};
  const double significance = testing::sidak(1e-4, cases.size() * roughnesses.size() * cosines.size());
  Random random(7);
  for (const BsdfCase& c : cases) {
    for (const float roughness : roughnesses) {
      for (const float cosine : cosines) {
        SCOPED_TRACE(describe(c, roughness, cosine));
        const Bsdf bsdf = flat_bsdf(c, roughness, incident(cosine));
        const bool narrow =
            roughness < 0.3f || (c.material.clearcoat > 0.0f && c.material.clearcoat_roughness < 0.3f);
        std::vector<double> expected = integrate_cells(bsdf, narrow ? 5 : 3);
        std::vector<double> observed(expected.size() + 1);
        double sum = 0.0;
        for (double& mass : expected) {
          sum += mass;
          mass *= kSamples;
        }
        EXPECT_LT(sum, 1.0 + 1e-3);
        // The last cell is for deltas and for what was rejected below the surface.
        expected.push_back(std::max(0.0, 1.0 - sum) * kSamples);
        for (int i = 0; i < kSamples; ++i) {
          const BsdfSample sample =
              bsdf.sample(random.uniform_float(), {random.uniform_float(), random.uniform_float()});
          const bool counts = sample.pdf > 0.0f && !sample.delta;
          observed[counts ? cell_of(sample.wi) : expected.size() - 1] += 1.0;
        }
        if (observed.back() == 0.0 && expected.back() < 1e-3 * kSamples) expected.back() = 0.0;
        EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected), significance));
      }
    }
  }
}

TEST(BsdfSampling, WeightIsValueOverDensity) {
  Random random(11);
  for (const BsdfCase& c : colored_cases()) {
    for (const float roughness : {0.05f, 0.3f, 0.8f}) {
      for (const float cosine : {1.0f, 0.3f, 0.02f}) {
        SCOPED_TRACE(describe(c, roughness, cosine));
        const Bsdf bsdf = flat_bsdf(c, roughness, incident(cosine));
        for (int i = 0; i < 200; ++i) {
          const BsdfSample sample =
              bsdf.sample(random.uniform_float(), {random.uniform_float(), random.uniform_float()});
          if (sample.delta || !(sample.pdf > 0.0f)) continue;
          const BsdfValue value = bsdf.evaluate(sample.wi);
          ASSERT_NEAR(sample.wi.norm(), 1.0f, 1e-5f);
          ASSERT_FLOAT_EQ(value.pdf, sample.pdf);
          for (int k = 0; k < 3; ++k) ASSERT_FLOAT_EQ(value.value[k], sample.weight[k] * sample.pdf);
          ASSERT_EQ(sample.transmitted, sample.wi.z() < 0.0f);
        }
      }
    }
  }
}

TEST(BsdfSampling, EveryLobeIsFoundAtBothEndsOfItsShare) {
  // The largest number below one must not fall through to no lobe at all.
  const float last = 1.0f - 0x1p-24f;
  for (const BsdfCase& c : colored_cases()) {
    for (const float roughness : {0.0f, 0.5f, 1.0f}) {
      SCOPED_TRACE(describe(c, roughness, 0.8f));
      const Bsdf bsdf = flat_bsdf(c, roughness, incident(0.8f));
      EXPECT_GT(bsdf.sample(0.0f, {0.3f, 0.3f}).pdf, 0.0f);
      EXPECT_GT(bsdf.sample(last, {0.3f, 0.3f}).pdf, 0.0f);
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
