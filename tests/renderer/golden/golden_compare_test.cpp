// The comparison of golden pictures on made-up samples whose distribution is known.

#include "tests/renderer/golden/golden_compare.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/statistics.h"

namespace gatelight::testing {
namespace {

constexpr int kWidth = 18;
constexpr int kHeight = 14;

using Sample = std::function<double(Random&, int pixel)>;

/// A picture of means with its variance layer, as the film makes it.
renderer::Picture draw(const Sample& sample, int spp, std::uint64_t seed) {
  Random random(seed);
  renderer::Picture picture;
  picture.width = kWidth;
  picture.height = kHeight;
  picture.layers.resize(2);
  picture.layers[1].name = "variance";
  for (renderer::Layer& layer : picture.layers) layer.channels = {"R", "G", "B"};
  for (int pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    Moments m;
    for (int i = 0; i < spp; ++i) m.add(sample(random, pixel));
    for (int channel = 0; channel < 3; ++channel) {
      picture.layers[0].values.push_back(static_cast<float>(m.mean()));
      picture.layers[1].values.push_back(static_cast<float>(m.variance() / spp));
    }
  }
  return picture;
}

GoldenVerdict compare(const Sample& test, const Sample& reference, std::uint64_t seed, double significance) {
  return compare_with_reference({draw(test, 64, 2 * seed + 1), 64}, {draw(reference, 1024, 2 * seed), 1024},
                                significance);
}

double uniform(Random& random, int /*pixel*/) {
  return random.uniform();
}

/// One sample in two hundred carries nearly everything: at 64 samples most pixels have none of them.
double firefly(Random& random, int /*pixel*/) {
  const double dim = 0.1 * random.uniform();
  return random.uniform() < 0.005 ? 100.0 + dim : dim;
}

TEST(GoldenCompare, RejectsEqualDistributionsNoMoreOftenThanItMay) {
  for (const auto& [name, sample] :
       {std::pair<const char*, Sample>{"uniform", uniform}, {"firefly", firefly}}) {
    int rejected = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed)
      rejected += compare(sample, sample, seed, 0.05).agrees ? 0 : 1;
    // Of 20 tests at 5 % one is expected to fail, six or more with a probability of 3e-4.
    EXPECT_LT(rejected, 6) << name;
  }
}

TEST(GoldenCompare, DetectsThatEverythingIsFourPercentBrighter) {
  const Sample brighter = [](Random& random, int pixel) { return 1.04 * uniform(random, pixel); };
  EXPECT_FALSE(compare(brighter, uniform, 1, 1e-5).agrees);
}

TEST(GoldenCompare, DetectsOneWrongPixel) {
  const Sample wrong = [](Random& random, int pixel) {
    return uniform(random, pixel) + (pixel == 77 ? 0.4 : 0.0);
  };
  const GoldenVerdict verdict = compare(wrong, uniform, 2, 1e-5);
  EXPECT_FALSE(verdict.agrees);
  EXPECT_NE(verdict.report.find("pixels: smallest p"), std::string::npos);
  EXPECT_NE(verdict.report.find("x 5, y 4"), std::string::npos) << verdict.report;
  EXPECT_LT(verdict.pixel_p_values[3 * 77], 1e-6f);
}

TEST(GoldenCompare, DetectsDifferencesThatCancelInEveryBlock) {
  const Sample chequered = [](Random& random, int pixel) {
    return uniform(random, pixel) + ((pixel % kWidth + pixel / kWidth) % 2 ? 0.06 : -0.06);
  };
  EXPECT_FALSE(compare(chequered, uniform, 3, 1e-5).agrees);
}

TEST(GoldenCompare, ComparesPixelsWithoutNoiseByTheirValue) {
  const Sample one = [](Random&, int) { return 1.0; };
  const Sample nearly = [](Random&, int) { return 1.000001; };
  const Sample more = [](Random&, int pixel) { return pixel == 3 ? 1.001 : 1.0; };
  EXPECT_TRUE(compare(one, one, 4, 1e-4).agrees);
  EXPECT_TRUE(compare(nearly, one, 4, 1e-4).agrees);
  EXPECT_FALSE(compare(more, one, 4, 1e-4).agrees);
}

TEST(GoldenCompare, RejectsNaN) {
  const Sample nan = [](Random&, int pixel) { return pixel == 3 ? std::nan("") : 1.0; };
  const Sample one = [](Random&, int) { return 1.0; };
  EXPECT_FALSE(compare(nan, one, 5, 1e-4).agrees);
}

}  // namespace
}  // namespace gatelight::testing
