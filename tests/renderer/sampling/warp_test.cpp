#include "renderer/sampling/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/random_points.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

constexpr int kSamples = 200000;
constexpr int kBins = 24;

/// Chi-square of directions in cells of (cos theta in [z0, 1], azimuth) against a density of cos theta only.
template <typename Sample, typename Pdf>
void expect_directions_follow(Sample&& sample, Pdf&& pdf, double z0, std::uint64_t seed) {
  testing::Random random(seed);
  std::vector<double> observed(kBins * kBins, 0.0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 d = sample(testing::next_2d(random));
    ASSERT_NEAR(d.norm(), 1.0f, 1e-5f);
    const double z = (static_cast<double>(d.z()) - z0) / (1.0 - z0);
    ASSERT_GE(z, -1e-3);
    const double azimuth = std::atan2(d.y(), d.x()) / (2.0 * M_PI) + 0.5;
    const int row = std::clamp(static_cast<int>(z * kBins), 0, kBins - 1);
    const int column = std::clamp(static_cast<int>(azimuth * kBins), 0, kBins - 1);
    observed[static_cast<std::size_t>(row * kBins + column)] += 1.0;
  }
  std::vector<double> expected(observed.size());
  double total = 0.0;
  for (int row = 0; row < kBins; ++row) {
    const double low = z0 + (1.0 - z0) * row / kBins;
    const double high = z0 + (1.0 - z0) * (row + 1) / kBins;
    const double mass = testing::integrate([&](double z) { return static_cast<double>(pdf(z)); }, low, high) *
                        2.0 * M_PI / kBins;
    for (int column = 0; column < kBins; ++column) {
      expected[static_cast<std::size_t>(row * kBins + column)] = mass * kSamples;
      total += mass;
    }
  }
  EXPECT_NEAR(total, 1.0, 1e-5);
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                               testing::sidak(testing::kFamilySignificance, 8)));
}

TEST(WarpTest, DirectionsFollowTheirDensity) {
  expect_directions_follow(
      sample_cosine_hemisphere, [](double z) { return pdf_cosine_hemisphere(static_cast<float>(z)); }, 0.0,
      1);
  expect_directions_follow(
      sample_uniform_hemisphere, [](double) { return pdf_uniform_hemisphere(); }, 0.0, 2);
  expect_directions_follow(
      sample_uniform_sphere, [](double) { return pdf_uniform_sphere(); }, -1.0, 3);
}

TEST(WarpTest, ConcentricDiskIsUniform) {
  testing::Random random(5);
  std::vector<double> observed(kBins * kBins, 0.0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec2 p = sample_concentric_disk(testing::next_2d(random));
    const double r2 = p.cast<double>().squaredNorm();
    ASSERT_LE(r2, 1.0 + 1e-6);
    const double azimuth = std::atan2(p.y(), p.x()) / (2.0 * M_PI) + 0.5;
    const int row = std::clamp(static_cast<int>(r2 * kBins), 0, kBins - 1);
    const int column = std::clamp(static_cast<int>(azimuth * kBins), 0, kBins - 1);
    observed[static_cast<std::size_t>(row * kBins + column)] += 1.0;
  }
  const std::vector<double> expected(observed.size(), kSamples / static_cast<double>(observed.size()));
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                               testing::sidak(testing::kFamilySignificance, 8)));
}

TEST(WarpTest, TriangleIsUniformByArea) {
  // Cells of equal area: a grid of small triangles, addressed by the integer parts of the barycentrics.
  constexpr int kSide = 16;
  testing::Random random(6);
  std::vector<double> observed(kSide * kSide, 0.0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec2 b = sample_uniform_triangle(testing::next_2d(random));
    ASSERT_GE(b.x(), 0.0f);
    ASSERT_GE(b.y(), 0.0f);
    ASSERT_LE(b.x() + b.y(), 1.0f + 1e-6f);
    const double x = b.x() * kSide;
    const double y = b.y() * kSide;
    const int ix = std::min(static_cast<int>(x), kSide - 1);
    const int iy = std::min(static_cast<int>(y), kSide - 1 - ix);
    const bool upper = (x - ix) + (y - iy) > 1.0 && ix + iy < kSide - 1;
    // Upper triangles take the cells of the square's unused half.
    const int cell = upper ? (kSide - 1 - ix) * kSide + (kSide - 1 - iy) : ix * kSide + iy;
    observed[static_cast<std::size_t>(cell)] += 1.0;
  }
  const std::vector<double> expected(observed.size(), kSamples / static_cast<double>(observed.size()));
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                               testing::sidak(testing::kFamilySignificance, 8)));
}

TEST(WarpTest, BasesAreOrthonormalAndRightHanded) {
  testing::Random random(7);
  std::vector<Vec3> normals{
      Vec3::UnitX(),  Vec3::UnitY(),  Vec3::UnitZ(),     -Vec3::UnitX(),
      -Vec3::UnitY(), -Vec3::UnitZ(), Vec3(0, 0, -1.0f), Vec3(1e-4f, 0, -1).normalized()};
  for (int i = 0; i < 10000; ++i) {
    normals.push_back(sample_uniform_sphere(testing::next_2d(random)));
  }
  for (const Vec3& n : normals) {
    const Basis basis(n);
    EXPECT_NEAR(basis.tangent.norm(), 1.0f, 1e-5f);
    EXPECT_NEAR(basis.bitangent.norm(), 1.0f, 1e-5f);
    EXPECT_NEAR(basis.tangent.dot(basis.bitangent), 0.0f, 1e-5f);
    EXPECT_NEAR((basis.tangent.cross(basis.bitangent) - n).norm(), 0.0f, 1e-5f);
    const Vec3 local(0.1f, -0.7f, 0.3f);
    const Vec3 world = basis.to_world(local);
    const Vec3 again(basis.tangent.dot(world), basis.bitangent.dot(world), basis.normal.dot(world));
    EXPECT_NEAR((again - local).norm(), 0.0f, 1e-5f);
  }
}

TEST(WarpTest, SineAndCosineAreExact) {
  for (int i = -1000; i <= 1000; ++i) {
    const float angle = 0.25f * kPi * static_cast<float>(i) / 1000.0f;
    const Vec2 cs = cos_sin_octant(angle);
    EXPECT_NEAR(cs.x(), std::cos(static_cast<double>(angle)), 1.5e-7);
    EXPECT_NEAR(cs.y(), std::sin(static_cast<double>(angle)), 1.5e-7);
  }
  for (int i = 0; i <= 1000; ++i) {
    const float u = static_cast<float>(i) / 1000.0f;
    const Vec2 cs = cos_sin_turn(u);
    EXPECT_NEAR(cs.x(), std::cos(2.0 * M_PI * static_cast<double>(u)), 1e-6);
    EXPECT_NEAR(cs.y(), std::sin(2.0 * M_PI * static_cast<double>(u)), 1e-6);
  }
}

}  // namespace
}  // namespace gatelight::renderer
