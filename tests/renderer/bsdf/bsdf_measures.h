#pragma once
// The sum of the samples of a BSDF, and a test that they follow their density.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "renderer/bsdf/bsdf.h"
#include "tests/renderer/bsdf/bsdf_cases.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {

struct Furnace {
  std::array<double, 3> mean{};
  double error = 0.0;  ///< standard error of the red channel; an overestimate, as the samples are stratified
};

/// Power that comes back from a uniform surrounding.
inline Furnace furnace(const Bsdf& bsdf, testing::Random& random, int strata = 40) {
  constexpr int kLobes = 8;
  testing::Moments red;
  Furnace result;
  const auto jittered = [&](int i, int count) {
    return std::min((static_cast<float>(i) + random.uniform_float()) / static_cast<float>(count),
                    1.0f - 0x1p-24f);
  };
  for (int k = 0; k < kLobes; ++k) {
    for (int i = 0; i < strata; ++i) {
      for (int j = 0; j < strata; ++j) {
        const BsdfSample sample =
            bsdf.sample(jittered(k, kLobes), {jittered(i, strata), jittered(j, strata)});
        const Color power = sample.weight / sample.radiance_scale;
        red.add(static_cast<double>(power.x()));
        for (int channel = 0; channel < 3; ++channel) {
          result.mean[channel] += static_cast<double>(power[channel]) / (kLobes * strata * strata);
        }
      }
    }
  }
  result.error = red.standard_error();
  return result;
}

/// Expects that the albedo is the reflectance in a furnace.
inline void expect_albedo(const Bsdf& bsdf, const BsdfCase& c, float roughness, const Furnace& result) {
  const bool refracts = c.material.transmission > 0.0f && !c.material.thin_walled;
  double tolerance = (refracts && roughness > 0.0f ? 0.05 : 0.003) + 3.0 * result.error;
  // The steps of the table of anisotropic lobes are coarse.
  if (c.material.anisotropy > 0.0f) tolerance += 0.012;
  if (c.material.iridescence > 0.0f) tolerance += 0.08;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(result.mean[k], static_cast<double>(bsdf.albedo()[k]), tolerance) << "channel " << k;
    EXPECT_GE(bsdf.albedo()[k], 0.0f);
    EXPECT_LE(bsdf.albedo()[k], 1.0f);
  }
}

/// The cases whose albedo is accurate: in denser media the split of tinted glass into reflection and
/// transmission is coarse around the critical angle.
inline std::vector<BsdfCase> cases_of_albedos() {
  std::vector<BsdfCase> cases = colored_cases();
  std::erase_if(cases, [](const BsdfCase& c) {
    return c.material.transmission > 0.0f && !c.material.thin_walled && c.material.ior > 1.5f;
  });
  return cases;
}

inline constexpr int kThetas = 24;
inline constexpr int kPhis = 24;
inline constexpr double kTurn = 2.0 * 3.14159265358979323846;

inline std::size_t cell_of(const Vec3& wi) {
  const double theta = std::atan2(std::hypot(wi.x(), wi.y()), wi.z());
  const double phi = std::atan2(wi.y(), wi.x());
  const int i = std::min(static_cast<int>(theta / (kTurn / 2.0) * kThetas), kThetas - 1);
  const int j = std::min(static_cast<int>((phi < 0.0 ? phi + kTurn : phi) / kTurn * kPhis), kPhis - 1);
  return static_cast<std::size_t>(i * kPhis + j);
}

/// The density integrated over the cells; a plane of symmetry through wo saves half of the work. Grazing
/// lobes are narrow opposite to wo and just above and below the horizon, so those cells get more steps.
inline std::vector<double> integrate_cells(const Bsdf& bsdf, int steps, bool symmetric) {
  std::vector<double> cells(kThetas * kPhis);
  for (int i = 0; i < kThetas; ++i) {
    for (int j = 0; j < (symmetric ? kPhis / 2 : kPhis); ++j) {
      const double theta = kTurn / 2.0 / kThetas;
      const double phi = kTurn / kPhis;
      const bool horizon = i == kThetas / 2 - 1 || i == kThetas / 2;
      const int theta_steps = horizon ? 6 * steps : steps;
      const int phi_steps = j == kPhis / 2 - 1 || j == kPhis / 2 ? 12 * steps : steps;
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
      if (symmetric) cells[i * kPhis + kPhis - 1 - j] = mass;
    }
  }
  return cells;
}

/// Pearson's test of samples in cells over the sphere; wo is in the xz plane. `steps` of the quadrature: more
/// for narrow lobes. `symmetric`: about that plane. draw() returns the next BsdfSample.
template <class Draw>
testing::ChiSquareResult samples_against_density(const Bsdf& bsdf, int steps, int samples, bool symmetric,
                                                 Draw draw) {
  std::vector<double> expected = integrate_cells(bsdf, steps, symmetric);
  std::vector<double> observed(expected.size() + 1);
  double sum = 0.0;
  for (double& mass : expected) {
    sum += mass;
    mass *= samples;
  }
  EXPECT_LT(sum, 1.0 + 1e-3);
  // The last cell is for deltas and for samples rejected below the surface.
  expected.push_back(std::max(0.0, 1.0 - sum) * samples);
  for (int i = 0; i < samples; ++i) {
    const BsdfSample sample = draw();
    const bool counts = sample.pdf > 0.0f && !sample.delta;
    observed[counts ? cell_of(sample.wi) : expected.size() - 1] += 1.0;
  }
  if (observed.back() == 0.0 && expected.back() < 1e-3 * samples) expected.back() = 0.0;
  return testing::chi_square_test(observed, expected);
}
inline testing::ChiSquareResult samples_against_density(const Bsdf& bsdf, int steps, int samples,
                                                        bool symmetric, testing::Random& random) {
  return samples_against_density(bsdf, steps, samples, symmetric, [&] {
    return bsdf.sample(random.uniform_float(), {random.uniform_float(), random.uniform_float()});
  });
}

}  // namespace gatelight::renderer
