#include "renderer/metrics/ssim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/renderer/metrics/metric_pictures.h"
#include "tests/support/messages.h"
#include "tests/support/rgb_pictures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using gatelight::testing::Random;
using gatelight::testing::rgb;
using gatelight::testing::uniform;
using tests::expect_message;

constexpr double kC1 = 1e-4;
constexpr double kC2 = 9e-4;

/// Some values are beyond white and below black.
Picture pattern(int width, int height, std::uint64_t seed) {
  return gatelight::testing::blotched(width, height, seed, 0.8f, 0.05f, 0.4f, -0.1f);
}

Picture disturbed(Picture picture, std::uint64_t seed) {
  Random random(seed);
  for (float& value : picture.layers[0].values) value += 0.3f * (random.uniform_float() - 0.3f);
  return picture;
}

double measure(const Picture& reference, const Picture& test, const SsimOptions& options = {}) {
  return ssim({reference, "ref.exr"}, {test, "test.exr"}, options);
}

/// Equation 13 of the paper, window after window, every weight and product as it stands there.
double plain_ssim(const Picture& a, const Picture& b) {
  const auto grey = [](const Picture& picture, int x, int y) {
    double sum = 0.0;
    const std::array<double, 3> weights{0.299, 0.587, 0.114};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = 3 * static_cast<std::size_t>(y * picture.width + x) + c;
      const double light = std::clamp(static_cast<double>(picture.layers[0].values[at]), 0.0, 1.0);
      sum += weights[c] * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055);
    }
    return sum;
  };
  double all = 0.0;
  int windows = 0;
  for (int cy = 5; cy + 5 < a.height; ++cy) {
    for (int cx = 5; cx + 5 < a.width; ++cx) {
      double total = 0.0, mean_a = 0.0, mean_b = 0.0;
      const auto each = [&](auto&& add) {
        for (int y = -5; y <= 5; ++y) {
          for (int x = -5; x <= 5; ++x)
            add(std::exp(-(x * x + y * y) / (2.0 * 1.5 * 1.5)), grey(a, cx + x, cy + y),
                grey(b, cx + x, cy + y));
        }
      };
      each([&](double w, double va, double vb) {
        total += w;
        mean_a += w * va;
        mean_b += w * vb;
      });
      mean_a /= total;
      mean_b /= total;
      double variance_a = 0.0, variance_b = 0.0, covariance = 0.0;
      each([&](double w, double va, double vb) {
        variance_a += w / total * (va - mean_a) * (va - mean_a);
        variance_b += w / total * (vb - mean_b) * (vb - mean_b);
        covariance += w / total * (va - mean_a) * (vb - mean_b);
      });
      all += (2.0 * mean_a * mean_b + kC1) * (2.0 * covariance + kC2) /
             ((mean_a * mean_a + mean_b * mean_b + kC1) * (variance_a + variance_b + kC2));
      ++windows;
    }
  }
  return all / windows;
}

TEST(Ssim, AgreesWithThePlainFormula) {
  // One window, one row and one column of them, more rows than a task.
  for (const auto& [width, height] : {std::pair{11, 11}, {40, 11}, {11, 33}, {27, 60}}) {
    const Picture a = pattern(width, height, 1);
    for (const Picture& b :
         {disturbed(a, 2), pattern(width, height, 3), uniform(width, height, {0.2f, 0.2f, 0.2f})}) {
      EXPECT_NEAR(measure(a, b), plain_ssim(a, b), 2e-6) << width << "x" << height;
    }
  }
}

TEST(Ssim, EvenPicturesHaveAClosedForm) {
  // Without structure only the means count.
  const auto expected = [](double a, double b) { return (2.0 * a * b + kC1) / (a * a + b * b + kC1); };
  EXPECT_NEAR(measure(uniform(12, 13, {0, 0, 0}), uniform(12, 13, {1, 1, 1})), expected(0.0, 1.0), 1e-9);
  EXPECT_NEAR(measure(uniform(12, 13, {1, 0, 0}), uniform(12, 13, {0, 1, 0})), expected(0.299, 0.587), 1e-6);
  EXPECT_NEAR(measure(uniform(12, 13, {0, 0, 1}), uniform(12, 13, {1, 1, 1})), expected(0.114, 1.0), 1e-6);
}

TEST(Ssim, EqualPicturesGiveExactlyOne) {
  for (const float scale : {1e-6f, 0.3f, 1.0f, 1e6f}) {
    Picture picture = pattern(33, 41, 4);
    for (float& value : picture.layers[0].values) value *= scale;
    EXPECT_EQ(measure(picture, picture), 1.0);
  }
  EXPECT_EQ(measure(uniform(11, 11, {0, 0, 0}), uniform(11, 11, {0, 0, 0})), 1.0);
}

TEST(Ssim, IsSymmetricAndNegativeForTheOpposite) {
  const Picture a = pattern(31, 35, 5);
  const Picture b = disturbed(a, 6);
  EXPECT_EQ(measure(a, b), measure(b, a));
  std::vector<float> checks, opposite;
  for (int i = 0; i < 20 * 20; ++i) {
    const float value = (i / 20 + i) % 2 == 0 ? 0.0f : 1.0f;
    checks.insert(checks.end(), 3, value);
    opposite.insert(opposite.end(), 3, 1.0f - value);
  }
  EXPECT_LT(measure(rgb(20, 20, checks), rgb(20, 20, opposite)), -0.99);
}

TEST(Ssim, RadianceIsShownWithExposureAndCurve) {
  const Picture a = pattern(20, 15, 7);
  gatelight::testing::expect_shown_pictures<SsimOptions>(
      a, disturbed(a, 8),
      [](const Picture& x, const Picture& y, const SsimOptions& o) { return measure(x, y, o); });
}

TEST(Ssim, TheSameBitsForAnyNumberOfThreads) {
  const Picture a = pattern(50, 150, 9);
  const Picture b = disturbed(a, 10);
  gatelight::testing::expect_same_for_any_threads([&] { return measure(a, b); });
}

std::string refusal(const Picture& reference, const Picture& test) {
  return tests::refusal<InputError>([&] { measure(reference, test); });
}

TEST(Ssim, RefusesPicturesForWhichItIsNotDefined) {
  const Picture good = uniform(12, 12, {1, 1, 1});
  expect_message(refusal(good, uniform(12, 13, {1, 1, 1})), {"ref.exr", "12x12", "test.exr", "12x13"});
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    Picture other = good;
    other.layers[0].values[70] = bad;
    expect_message(refusal(good, other), {"test.exr", "1", "SSIM"});
  }
  expect_message(refusal(uniform(10, 12, {1, 1, 1}), uniform(10, 12, {1, 1, 1})), {"10x12", "11x11"});
}

}  // namespace
}  // namespace gatelight::renderer
