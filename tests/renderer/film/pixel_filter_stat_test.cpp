#include "renderer/film/pixel_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/sampling/sampler.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

struct Case {
  PixelFilter filter;
  float width;
  double (*density)(double);  ///< unnormalised, of the offset over half the width, in [-1, 1]
};

const Case kFilterCases[] = {
    Case{PixelFilter::box, 1.0f, [](double) { return 1.0; }},
    Case{PixelFilter::tent, 2.0f, [](double x) { return 1.0 - std::abs(x); }},
    Case{PixelFilter::gaussian, 3.0f, [](double x) { return std::exp(-4.5 * x * x) - std::exp(-4.5); }},
    Case{PixelFilter::blackman_harris, 3.0f, [](double x) {
           const double a = M_PI * (x + 1.0);
           return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
         }}};

TEST(PixelFilterStat, OffsetsAreDistributedAsTheFilter) {
  for (const Case& c : kFilterCases) {
    const FilterSampler filter(c.filter, 0.0f);
    EXPECT_FLOAT_EQ(filter.width(), c.width);
    constexpr int kBins = 40;
    constexpr int kCount = 200000;
    std::vector<double> expected(kBins);
    double total = 0.0;
    for (int i = 0; i < kBins; ++i) {
      for (int k = 0; k < 100; ++k) {
        expected[static_cast<std::size_t>(i)] += c.density(-1.0 + 2.0 * (i + (k + 0.5) / 100.0) / kBins);
      }
      total += expected[static_cast<std::size_t>(i)];
    }
    for (double& e : expected) e *= kCount / total;
    std::vector<double> x(kBins);
    std::vector<double> y(kBins);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Sampler sampler(SamplerKind::independent, 5, 0, 0, i);
      const Vec2 o = filter.sample(sampler.get_2d(0)) / filter.width() + Vec2(0.5f, 0.5f);
      ASSERT_TRUE((o.array() >= 0.0f).all() && (o.array() <= 1.0f).all());
      ++x[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(o.x() * kBins))];
      ++y[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(o.y() * kBins))];
    }
    const double significance = testing::sidak(1e-4, 8);
    EXPECT_TRUE(testing::accepts(testing::chi_square_test(x, expected), significance));
    EXPECT_TRUE(testing::accepts(testing::chi_square_test(y, expected), significance));
  }
}

}  // namespace
}  // namespace gatelight::renderer
