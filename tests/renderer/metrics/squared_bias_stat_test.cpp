// The bias that is estimated from halves with independent noise.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/metrics/compare.h"
#include "renderer/metrics/merge.h"
#include "tests/support/rgb_pictures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using gatelight::testing::mean_p_value;
using gatelight::testing::Moments;
using gatelight::testing::Random;
using gatelight::testing::sidak;
using gatelight::testing::uniform;

constexpr int kSize = 40;
constexpr int kRuns = 60;

/// The true picture: from dark to bright.
float truth(std::size_t i) {
  return 0.05f + static_cast<float>(i % 97) / 50.0f;
}

/// truth() times `bias` with skewed noise of mean 0: exponential, as Monte Carlo's is more often than normal.
Picture noisy(Random& random, float bias, float noise) {
  Picture picture{.width = kSize, .height = kSize};
  picture.layers = {{.channels = {"R", "G", "B"}}};
  for (std::size_t i = 0; i < 3 * kSize * kSize; ++i) {
    const float exponential = static_cast<float>(-std::log1p(-random.uniform()) - 1.0);
    picture.layers[0].values.push_back(truth(i) * (bias + noise * exponential));
  }
  return picture;
}

/// The estimates of many runs.
Moments estimates(float bias, float reference_noise, float test_noise, std::uint64_t seed) {
  Random random(seed);
  Moments moments;
  for (int run = 0; run < kRuns; ++run) {
    const Picture r1 = noisy(random, 1.0f, reference_noise);
    const Picture r2 = noisy(random, 1.0f, reference_noise);
    const Picture t1 = noisy(random, bias, test_noise);
    const Picture t2 = noisy(random, bias, test_noise);
    moments.add(squared_bias({{r1, "r1"}, {r2, "r2"}}, {{t1, "t1"}, {t2, "t2"}}));
  }
  return moments;
}

/// Mean of truth^2 (bias - 1)^2 / (truth^2 + 1e-2).
double true_squared_bias(double bias) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3 * kSize * kSize; ++i) {
    const double t = static_cast<double>(truth(i));
    sum += t * t * (bias - 1.0) * (bias - 1.0) / (t * t + 1e-2);
  }
  return sum / (3.0 * kSize * kSize);
}

// The reference's noise is small beside the test's, as the formula wants it.
constexpr float kReferenceNoise = 0.02f;
constexpr std::size_t kTests = 4;

TEST(SquaredBias, IsZeroOnAverageWithoutBias) {
  for (const float noise : {0.1f, 1.0f}) {
    const Moments moments = estimates(1.0f, kReferenceNoise, noise, 11);
    EXPECT_GT(mean_p_value(moments, 0.0), sidak(1e-4, kTests)) << moments.mean();
    // The plain error of one picture is all noise.
    EXPECT_LT(moments.standard_error(), 0.01 * static_cast<double>(noise * noise));
  }
}

TEST(SquaredBias, IsTheSquaredOffsetOnAverage) {
  for (const float bias : {0.9f, 1.3f}) {
    const Moments moments = estimates(bias, kReferenceNoise, 0.5f, 12);
    const double expected = true_squared_bias(static_cast<double>(bias));
    EXPECT_GT(mean_p_value(moments, expected), sidak(1e-4, kTests)) << moments.mean() << " " << expected;
    EXPECT_LT(moments.standard_error(), 0.2 * expected) << "the test could not fail";
  }
}

TEST(SquaredBias, WithoutNoiseItIsTheRelativeError) {
  Random random(13);
  const Picture r = noisy(random, 1.0f, 0.0f);
  const Picture t = noisy(random, 1.2f, 0.0f);
  const double bias = squared_bias({{r, "r"}, {r, "r"}}, {{t, "t"}, {t, "t"}});
  EXPECT_NEAR(bias / compare_pictures({r, "r"}, {t, "t"}).rel_mse, 1.0, 1e-12);
}

TEST(SquaredBias, PixelsThatAreNotFiniteAreLeftOutAndSizesMustAgree) {
  const Picture one = uniform(2, 1, {1, 1, 1}), two = uniform(2, 1, {2, 2, 2});
  Picture broken = two;
  broken.layers[0].values[4] = std::nanf("");
  EXPECT_NEAR(squared_bias({{one, "r"}, {one, "r"}}, {{two, "t"}, {broken, "t"}}), 1.0 / 1.01, 1e-12);
  const Picture narrow = uniform(1, 1, {1, 1, 1});
  EXPECT_THROW(squared_bias({{one, "r"}, {one, "r"}}, {{two, "t"}, {narrow, "t"}}), InputError);
}

}  // namespace
}  // namespace gatelight::renderer
