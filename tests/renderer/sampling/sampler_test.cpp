#include "renderer/sampling/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

const std::array kKinds{SamplerKind::sobol, SamplerKind::independent};

TEST(SamplerTest, SobolPairsFillEveryElementaryInterval) {
  // Every aligned block of 2^k samples, not only the first, and late ones too.
  for (std::uint32_t pixel = 0; pixel < 8; ++pixel) {
    for (const std::uint32_t dimension : {0u, 1u, 17u, 4000000000u}) {
      for (int k = 0; k <= 12; ++k) {
        const std::uint32_t count = 1u << k;
        for (const std::uint32_t first : {0u, count, 0xffffffffu - (count - 1u)}) {
          std::vector<Vec2> points;
          for (std::uint32_t i = 0; i < count; ++i) {
            points.push_back(Sampler(SamplerKind::sobol, 3, pixel, 5, first + i).get_2d(dimension));
          }
          for (int columns_log2 = 0; columns_log2 <= k; ++columns_log2) {
            const std::uint32_t columns = 1u << columns_log2;
            const std::uint32_t rows = count / columns;
            std::vector<bool> taken(count, false);
            for (const Vec2& p : points) {
              const auto column = static_cast<std::uint32_t>(p.x() * static_cast<float>(columns));
              const auto row = static_cast<std::uint32_t>(p.y() * static_cast<float>(rows));
              ASSERT_FALSE(taken[row * columns + column])
                  << "k " << k << " columns " << columns << " first " << first;
              taken[row * columns + column] = true;
            }
          }
        }
      }
    }
  }
}

TEST(SamplerTest, PairsOfAScreenFillEveryElementaryInterval) {
  // All samples of an aligned square of pixels, near the origin and far from it.
  for (const std::uint32_t spp : {1u, 4u, 8u}) {
    for (const std::uint32_t first : {0u, 64u, 64u * 1000u}) {
      constexpr std::uint32_t kPixels = 64;
      const std::uint32_t count = kPixels * spp;
      const int k = std::countr_zero(count);
      std::vector<Vec2> points;
      for (std::uint32_t i = 0; i < count; ++i)
        points.push_back(Sampler::of_screen(3, first + i / spp, spp, i % spp).get_2d(17));
      for (int columns_log2 = 0; columns_log2 <= k; ++columns_log2) {
        const std::uint32_t columns = 1u << columns_log2, rows = count / columns;
        std::vector<bool> taken(count, false);
        for (const Vec2& p : points) {
          const auto column = static_cast<std::uint32_t>(p.x() * static_cast<float>(columns));
          const auto row = static_cast<std::uint32_t>(p.y() * static_cast<float>(rows));
          ASSERT_FALSE(taken[row * columns + column]) << "spp " << spp << " columns " << columns;
          taken[row * columns + column] = true;
        }
      }
    }
  }
}

TEST(SamplerTest, LaterSamplesOfAScreenAndSeedsAreOtherSequences) {
  const auto key = [](std::uint32_t seed, std::uint32_t sample) {
    return Sampler::of_screen(seed, 5, 8, sample).key();
  };
  EXPECT_EQ(key(1, 0), key(1, 7));
  EXPECT_NE(key(1, 7), key(1, 8));
  EXPECT_NE(key(1, 0), key(2, 0));
}

TEST(SamplerTest, SobolNumbersAreStratifiedInOneDimension) {
  for (std::uint32_t pixel = 0; pixel < 32; ++pixel) {
    std::vector<bool> taken(1024, false);
    for (std::uint32_t i = 0; i < 1024; ++i) {
      const auto cell =
          static_cast<std::size_t>(Sampler(SamplerKind::sobol, 0, pixel, 0, i).get_1d(9) * 1024.0f);
      ASSERT_FALSE(taken[cell]);
      taken[cell] = true;
    }
  }
}

TEST(SamplerTest, NumbersAreInTheHalfOpenUnitIntervalForAnyKey) {
  testing::Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const std::uint64_t a = random.bits();
    const std::uint64_t b = random.bits();
    const auto index =
        i % 4 == 0 ? 0xffffffffu - static_cast<std::uint32_t>(i) : static_cast<std::uint32_t>(a);
    const Sampler sampler(kKinds[i % 2], static_cast<std::uint32_t>(a >> 32), static_cast<std::uint32_t>(b),
                          static_cast<std::uint32_t>(b >> 32), index);
    const float x = sampler.get_1d(static_cast<std::uint32_t>(i));
    const Vec2 p = sampler.get_2d(static_cast<std::uint32_t>(i));
    ASSERT_TRUE(x >= 0.0f && x < 1.0f);
    ASSERT_TRUE((p.array() >= 0.0f).all() && (p.array() < 1.0f).all());
  }
  EXPECT_LT(sampling::to_unit_float(0xffffffffu), 1.0f);
}

// Over pixels the scrambling makes each sample uniform on its own: a cell of the unit square for each of the
// first samples, many pixels.
TEST(SamplerTest, EachSampleIsUniformOverPixels) {
  constexpr int kCells = 16;
  constexpr int kPixels = 40000;
  const std::array<std::uint32_t, 4> indices{0, 1, 2, 100000};
  const double significance = testing::sidak(testing::kFamilySignificance, 2 * indices.size());
  for (const SamplerKind kind : kKinds) {
    for (const std::uint32_t index : indices) {
      std::vector<double> observed(kCells * kCells, 0.0);
      for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        const Vec2 p = Sampler(kind, 0, pixel % 200, pixel / 200, index).get_2d(5);
        observed[static_cast<std::size_t>(p.y() * kCells) * kCells +
                 static_cast<std::size_t>(p.x() * kCells)] += 1.0;
      }
      const std::vector<double> expected(observed.size(), kPixels / static_cast<double>(observed.size()));
      EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected), significance));
    }
  }
}

// Joint histograms of numbers that must be independent. Sobol points within one pixel are more
// regular than chance along each axis, which only lowers the statistic; correlation raises it.
TEST(SamplerTest, DimensionsAndPixelsAreUncorrelated) {
  constexpr int kCells = 16;
  constexpr std::uint32_t kSamples = 1 << 15;
  const auto independent = [&](auto&& first, auto&& second) {
    std::vector<double> observed(kCells * kCells, 0.0);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      observed[static_cast<std::size_t>(first(i) * kCells) * kCells +
               static_cast<std::size_t>(second(i) * kCells)] += 1.0;
    }
    const std::vector<double> expected(observed.size(), kSamples / static_cast<double>(observed.size()));
    return testing::chi_square_test(observed, expected);
  };
  const double significance = testing::sidak(testing::kFamilySignificance, 2 * 8 * 4);
  for (const SamplerKind kind : kKinds) {
    for (std::uint32_t d = 0; d < 8; ++d) {
      const auto at = [kind](std::uint32_t x, std::uint32_t i) { return Sampler(kind, 0, x, 0, i); };
      EXPECT_TRUE(testing::accepts(independent([&](std::uint32_t i) { return at(0, i).get_1d(d); },
                                               [&](std::uint32_t i) { return at(0, i).get_1d(d + 1); }),
                                   significance))
          << "neighbouring dimensions, " << d;
      EXPECT_TRUE(testing::accepts(independent([&](std::uint32_t i) { return at(0, i).get_2d(d).x(); },
                                               [&](std::uint32_t i) { return at(0, i).get_2d(d + 1).y(); }),
                                   significance))
          << "pairs of neighbouring dimensions, " << d;
      EXPECT_TRUE(testing::accepts(independent([&](std::uint32_t i) { return at(d, i).get_1d(3); },
                                               [&](std::uint32_t i) { return at(d + 1, i).get_1d(3); }),
                                   significance))
          << "neighbouring pixels, " << d;
      // One sample a pixel, along a row: a picture's noise must be white.
      EXPECT_TRUE(testing::accepts(independent([&](std::uint32_t i) { return at(i, 0).get_1d(d); },
                                               [&](std::uint32_t i) { return at(i + 1, 0).get_1d(d); }),
                                   significance))
          << "a row of pixels, " << d;
    }
  }
}

// A product of smooth functions of two padded dimensions: Sobol must beat the independent sampler clearly.
TEST(SamplerTest, SobolIntegratesWithFarLessVariance) {
  const auto variance = [](SamplerKind kind) {
    testing::Moments moments;
    for (std::uint32_t pixel = 0; pixel < 400; ++pixel) {
      double sum = 0.0;
      for (std::uint32_t i = 0; i < 64; ++i) {
        const Vec2 p = Sampler(kind, 0, pixel, 0, i).get_2d(2);
        sum += static_cast<double>(p.x() * p.x() + p.y());
      }
      moments.add(sum / 64.0);
    }
    return moments.variance();
  };
  EXPECT_LT(variance(SamplerKind::sobol) * 30.0, variance(SamplerKind::independent));
}

TEST(SamplerTest, MeansAreUnbiased) {
  const double significance = testing::sidak(testing::kFamilySignificance, 2 * 3);
  for (const SamplerKind kind : kKinds) {
    std::array<testing::Moments, 3> moments;
    for (std::uint32_t pixel = 0; pixel < 20000; ++pixel) {
      const Sampler sampler(kind, 7, pixel, pixel / 3, pixel % 5);
      const Vec2 p = sampler.get_2d(4);
      moments[0].add(p.x());
      moments[1].add(p.y());
      moments[2].add(sampler.get_1d(6));
    }
    for (const testing::Moments& m : moments) EXPECT_GE(testing::mean_p_value(m, 0.5), significance);
  }
}

}  // namespace
}  // namespace gatelight::renderer
