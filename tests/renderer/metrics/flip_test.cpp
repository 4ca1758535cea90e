#include "renderer/metrics/flip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "base/errors.h"
#include "renderer/image/image_read.h"
#include "renderer/image/srgb.h"
#include "renderer/metrics/flip/color_map.h"
#include "renderer/metrics/flip/exposures.h"
#include "tests/renderer/metrics/flip_reference.h"
#include "tests/renderer/metrics/metric_pictures.h"
#include "tests/support/messages.h"
#include "tests/support/rgb_pictures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using gatelight::testing::changed;
using gatelight::testing::Random;
using gatelight::testing::rgb;
using gatelight::testing::uniform;
using ::testing::Each;
using tests::expect_message;

/// In [0, scale].
Picture blotches(int width, int height, std::uint64_t seed, float scale = 1.0f) {
  return gatelight::testing::blotched(width, height, seed, scale * 0.7f, scale * 0.1f, scale * 0.3f);
}

/// Some pixels of the blotches are changed: a little everywhere, much at some points.
Picture with_outliers(Picture picture, std::uint64_t seed, float scale = 1.0f) {
  Random random(seed);
  for (float& value : picture.layers[0].values) {
    value += scale * 0.1f * (random.uniform_float() - 0.5f);
    if (random.uniform() < 0.05) value = scale * random.uniform_float();
    value = std::clamp(value, 0.0f, scale);
  }
  return picture;
}

FlipResult ldr(const Picture& reference, const Picture& test, const FlipOptions& options = {}) {
  return ldr_flip({reference, "ref.exr"}, {test, "test.exr"}, options);
}
FlipResult hdr(const Picture& reference, const Picture& test, const FlipOptions& options = {}) {
  return hdr_flip({reference, "ref.exr"}, {test, "test.exr"}, options);
}

reference::Image as_image(const Picture& picture, double scale = 1.0) {
  reference::Image image{picture.width, picture.height, {}};
  const std::vector<float>& v = picture.layers[0].values;
  for (std::size_t i = 0; i < v.size(); i += 3) {
    image.pixels.push_back({scale * static_cast<double>(v[i]), scale * static_cast<double>(v[i + 1]),
                            scale * static_cast<double>(v[i + 2])});
  }
  return image;
}

double largest_difference(const std::vector<float>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - b[i]));
  }
  return largest;
}

struct Shape {
  int width, height;
  double ppd;
};

TEST(LdrFlip, EveryPixelAgreesWithTheWholeConvolutions) {
  // More rows than a band, pictures smaller than the filters, filters of one and of a hundred pixels.
  for (const auto& [width, height, ppd] : {Shape{37, 70, 67.02}, Shape{23, 11, 20.0}, Shape{12, 9, 1.0},
                                           Shape{1, 1, 67.02}, Shape{2, 40, 120.0}, Shape{9, 3, 300.0}}) {
    SCOPED_TRACE(::testing::Message() << width << "x" << height << ", " << ppd);
    const Picture a = blotches(width, height, 1);
    const Picture b = with_outliers(a, 2);
    const FlipResult result = ldr(a, b, {.pixels_per_degree = ppd});
    EXPECT_EQ(result.width, width);
    EXPECT_EQ(result.height, height);
    EXPECT_EQ(result.start_exposure, 0.0);
    EXPECT_EQ(result.stop_exposure, 0.0);
    EXPECT_EQ(result.exposures, 0);
    EXPECT_LT(largest_difference(result.errors, reference::ldr_flip(as_image(a), as_image(b), ppd)), 1e-4);
    EXPECT_GT(result.summary.mean, 0.01) << "there is something to compare";
  }
}

TEST(LdrFlip, EqualPicturesGiveExactlyZero) {
  for (const float scale : {1e-6f, 1.0f, 1e6f}) {
    const Picture picture = blotches(33, 41, 3, scale);
    const FlipResult result = ldr(picture, picture);
    EXPECT_THAT(result.errors, Each(0.0f));
    EXPECT_EQ(result.summary.mean, 0.0);
    EXPECT_EQ(result.summary.weighted_median, 0.0);
    EXPECT_EQ(result.summary.max, 0.0);
    EXPECT_THAT(hdr(picture, picture).errors, Each(0.0f));
  }
}

TEST(LdrFlip, IsSymmetric) {
  const Picture a = blotches(31, 35, 4);
  const Picture b = with_outliers(a, 5);
  EXPECT_EQ(ldr(a, b).errors, ldr(b, a).errors);
}

TEST(LdrFlip, EvenPicturesHaveClosedForms) {
  // The filters leave them as they are and find no features. Green and blue are the farthest colours.
  const FlipResult far = ldr(uniform(5, 4, {0, 1, 0}), uniform(5, 4, {0, 0, 1}));
  for (const float error : far.errors) EXPECT_NEAR(error, 1.0, 1e-5);
  // Black to white is 100 in lightness only.
  const double largest =
      std::pow(reference::hyab(reference::hunt_lab({0, 1, 0}), reference::hunt_lab({0, 0, 1})), 0.7);
  const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * largest) / (0.6 * largest);
  const FlipResult contrast = ldr(uniform(6, 6, {0, 0, 0}), uniform(6, 6, {1, 1, 1}));
  for (const float error : contrast.errors) EXPECT_NEAR(error, expected, 1e-5);
  // Dark grey differs from black by the linear foot of the lightness: 903.3 t.
  const double foot = 24389.0 / 27.0 * 0.004;
  const FlipResult dark = ldr(uniform(6, 6, {0, 0, 0}), uniform(6, 6, {0.004f, 0.004f, 0.004f}));
  for (const float error : dark.errors) {
    EXPECT_NEAR(error, 0.95 / (0.4 * largest) * std::pow(foot, 0.7), 1e-5);
  }
}

TEST(LdrFlip, RadianceIsShownWithExposureAndCurveAndCut) {
  const Picture a = blotches(9, 8, 6);
  const Picture b = with_outliers(a, 7);
  gatelight::testing::expect_shown_pictures<FlipOptions>(
      a, b, [](const Picture& x, const Picture& y, const FlipOptions& o) { return ldr(x, y, o).errors; });
  const auto cut = [](float x) { return std::clamp(3.0f * x - 0.5f, 0.0f, 1.0f); };
  const auto wide = [](float x) { return 3.0f * x - 0.5f; };
  EXPECT_EQ(ldr(changed(a, wide), changed(b, wide)).errors, ldr(changed(a, cut), changed(b, cut)).errors);
}

TEST(LdrFlip, TheSameBitsForAnyNumberOfThreads) {
  const Picture a = blotches(50, 150, 8);
  const Picture b = with_outliers(a, 9);
  gatelight::testing::expect_same_for_any_threads([&] {
    const FlipResult result = hdr(a, b);
    return std::pair(result.errors, result.summary.mean);
  });
}

TEST(HdrFlip, IsTheLargestLdrErrorOverTheExposures) {
  const Picture a = blotches(14, 11, 10, 50.0f);
  const Picture b = with_outliers(a, 11, 50.0f);
  const FlipResult result = hdr(a, b);
  std::vector<double> expected(result.errors.size(), 0.0);
  for (int i = 0; i < result.exposures; ++i) {
    const double stops =
        result.start_exposure + i * (result.stop_exposure - result.start_exposure) / (result.exposures - 1);
    const auto shown = [&](const Picture& picture) {
      reference::Image image = as_image(picture, 0.6 * std::exp2(stops));
      for (reference::Color& color : image.pixels) {
        for (double& v : color) {
          v = std::clamp(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14), 0.0, 1.0);
        }
      }
      return image;
    };
    const std::vector<double> errors =
        reference::ldr_flip(shown(a), shown(b), FlipOptions{}.pixels_per_degree);
    for (std::size_t p = 0; p < errors.size(); ++p) expected[p] = std::max(expected[p], errors[p]);
  }
  EXPECT_LT(largest_difference(result.errors, expected), 1e-4);
}

/// HDR-FLIP of a reference of greys and a red picture.
FlipResult hdr_of_greys(const std::vector<float>& greys) {
  std::vector<float> values;
  for (const float grey : greys) values.insert(values.end(), 3, grey);
  const Picture picture = rgb(static_cast<int>(greys.size()), 1, values);
  return hdr(picture, uniform(picture.width, 1, {1, 0, 0}));
}

double shown_at(double radiance, double stops) {
  return static_cast<double>(filmic(static_cast<float>(0.6 * radiance * std::exp2(stops))));
}

TEST(HdrFlip, ExposuresShowTheBrightestAndTheMedianJustBelowWhite) {
  const FlipResult odd = hdr_of_greys({0.25f, 20.0f, 0.5f, 0.1f, 7.0f});
  EXPECT_NEAR(shown_at(20.0, odd.start_exposure), 0.85, 1e-5);
  EXPECT_NEAR(shown_at(0.5, odd.stop_exposure), 0.85, 1e-5);
  EXPECT_EQ(odd.exposures, 6) << "log2(40) = 5.3 stops";
  const FlipResult even = hdr_of_greys({1.0f, 4.0f, 3.0f, 2.0f});
  EXPECT_NEAR(even.stop_exposure - even.start_exposure, std::log2(4.0 / 2.5), 1e-6);
  EXPECT_EQ(even.exposures, 2);
  EXPECT_EQ(hdr_of_greys({1.0f, 1.0f, 1.0f}).exposures, 2);
}

TEST(HdrFlip, ReportsProgressAndCanBeEndedBeforeEachExposure) {
  const Picture a = rgb(5, 1, {0.25f, 0.25f, 0.25f, 20, 20, 20, 0.5f, 0.5f, 0.5f, 0.1f, 0.1f, 0.1f, 7, 7, 7});
  const Picture b = with_outliers(a, 14, 20.0f);
  std::vector<double> reported;
  const auto call = [&](std::size_t most) {
    reported.clear();
    return hdr_flip({a, "a.exr"}, {b, "b.exr"}, {}, [&](double fraction) {
      reported.push_back(fraction);
      return reported.size() <= most;
    });
  };
  EXPECT_EQ(call(100)->errors, hdr(a, b).errors);
  EXPECT_THAT(reported, ::testing::ElementsAre(0.0, 1.0 / 6, 2.0 / 6, 3.0 / 6, 4.0 / 6, 5.0 / 6));
  EXPECT_FALSE(call(2).has_value());
  EXPECT_EQ(reported.size(), 3u);
}

TEST(HdrFlip, BlackReferencesHaveExposuresToo) {
  const FlipResult mostly = hdr_of_greys({0, 0, 0, 0, 0, 8.0f, 2.0f, 1.0f});
  EXPECT_NEAR(shown_at(2.0, mostly.stop_exposure), 0.85, 1e-5) << "the median without black pixels";
  const FlipResult black = hdr_of_greys({0, 0, 0, -1.0f});
  EXPECT_EQ(black.start_exposure, 0.0);
  EXPECT_EQ(black.exposures, 1);
  EXPECT_GT(black.summary.mean, 0.1);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfRadiance) {
  const Picture a = blotches(20, 10, 12);
  const Picture b = with_outliers(a, 13);
  const FlipResult expected = hdr(a, b);
  for (const float unit : {0x1p-20f, 0x1p20f}) {
    const auto scaled = [=](float value) { return unit * value; };
    const FlipResult result = hdr(changed(a, scaled), changed(b, scaled));
    for (std::size_t p = 0; p < result.errors.size(); ++p)
      EXPECT_NEAR(result.errors[p], expected.errors[p], 1e-4);
  }
}

TEST(HdrFlip, StaysFiniteAtTheEndsOfFloat) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  const float huge = std::numeric_limits<float>::max();
  const Picture a = rgb(3, 1, {tiny, 0, tiny, tiny, tiny, tiny, huge, 0, huge});
  const Picture b = rgb(3, 1, {huge, huge, 0, 0, 0, 0, -huge, tiny, 1});
  for (const FlipResult& result : {hdr(a, b), ldr(a, b)}) {
    for (const float error : result.errors) EXPECT_TRUE(error >= 0.0f && error <= 1.0f) << error;
  }
}

TEST(HdrFlip, DetectsRadianceNearTheGreatestFloat) {
  const Picture black = rgb(1, 1, {0, 0, 0});
  const float expected = hdr(rgb(1, 1, {1, 1, 1}), black).errors[0];
  EXPECT_GT(expected, 0.5f);
  EXPECT_NEAR(hdr(rgb(1, 1, {3e38f, 3e38f, 3e38f}), black).errors[0], expected, 1e-4);
}

TEST(FlipSummary, MatchesTheHandWorkedExample) {
  const FlipSummary s = summarize(std::vector<float>{0.5f, 0.0f, 0.25f, 0.125f, 0.125f});
  // Sorted 0, 1/8, 1/8, 1/4, 1/2; running sums 0, 1/8, 1/4, 1/2, 1: each quantile is where it is passed.
  EXPECT_DOUBLE_EQ(s.mean, 0.2);
  EXPECT_DOUBLE_EQ(s.first_quartile, 0.25);
  EXPECT_DOUBLE_EQ(s.weighted_median, 0.5);
  EXPECT_DOUBLE_EQ(s.third_quartile, 0.5);
  EXPECT_DOUBLE_EQ(s.min, 0.0);
  EXPECT_DOUBLE_EQ(s.max, 0.5);
}

std::string common_refusal(const Picture& reference, const Picture& test) {
  std::string first;
  for (const auto compare : {&ldr, &hdr}) {
    const std::string message = tests::refusal<InputError>([&] { compare(reference, test, {}); });
    EXPECT_TRUE(first.empty() || first == message);
    first = message;
  }
  return first;
}

TEST(Flip, UnusablePicturesAreRefusedByName) {
  const Picture good = uniform(2, 1, {1, 1, 1});
  expect_message(common_refusal(good, uniform(1, 2, {1, 1, 1})), {"ref.exr", "2x1", "test.exr", "1x2"});
  const Picture nan = rgb(2, 1, {1, 1, 1, 1, std::nanf(""), 1});
  expect_message(common_refusal(good, nan), {"test.exr", "1"});
  expect_message(common_refusal(uniform(2, 1, {1, std::numeric_limits<float>::infinity(), 1}), good),
                 {"ref.exr", "2"});
  expect_message(common_refusal(rgb(0, 0, {}), rgb(0, 0, {})), {"ref.exr"});
}

TEST(Flip, PixelsPerDegreeHaveARange) {
  const Picture picture = uniform(2, 1, {1, 1, 1});
  for (const double ppd : {0.5, 1001.0, std::nan("")}) {
    EXPECT_THROW(ldr(picture, picture, {.pixels_per_degree = ppd}), BadOption);
    EXPECT_THROW(hdr(picture, picture, {.pixels_per_degree = ppd}), BadOption);
  }
}

TEST(FlipMap, NoColourIsOffTheCurve) {
  // The map has equal steps for the eye, and the source every fifth of its colours.
  const auto color = [](int i) { return flip::magma(static_cast<float>(i) / 51.0f); };
  for (int i = 1; i < 51; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float bend = color(i - 1)[c] - 2.0f * color(i)[c] + color(i + 1)[c];
      EXPECT_LT(std::abs(bend), 0.0105f) << i << " " << c;
    }
  }
}

TEST(FlipMap, ShowsThePublishedColours) {
  struct Entry {
    int index;
    std::array<float, 3> color;
  };
  // Colours of the table of 256; most lie between those in the source.
  for (const Entry& entry :
       {Entry{0, {0.001462f, 0.000466f, 0.013866f}}, Entry{3, {0.004512f, 0.003490f, 0.029965f}},
        Entry{43, {0.178212f, 0.066576f, 0.379497f}}, Entry{64, {0.316654f, 0.071690f, 0.485380f}},
        Entry{128, {0.716387f, 0.214982f, 0.475290f}}, Entry{187, {0.981000f, 0.498428f, 0.369734f}},
        Entry{253, {0.987691f, 0.977154f, 0.734536f}}, Entry{255, {0.987053f, 0.991438f, 0.749504f}}}) {
    const std::array<float, 3> color = flip::magma(static_cast<float>(entry.index) / 255.0f);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c], entry.color[c], 1.0 / 255.0) << entry.index;
  }
  const FlipResult result{.width = 1, .height = 2, .errors = {0.0f, 1.0f}};
  const Picture map = flip_map(result);
  EXPECT_EQ(map.width, 1);
  EXPECT_EQ(map.height, 2);
  EXPECT_NEAR(linear_to_srgb(map.layers[0].values[5]), 0.749504f, 1e-5);
  EXPECT_NEAR(linear_to_srgb(map.layers[0].values[2]), 0.013866f, 1e-5);
}

TEST(FlipPair, HasThePublishedMeanAndQuartiles) {
  const char* folder = std::getenv("GATELIGHT_FLIP_PAIR");
  if (!folder) GTEST_SKIP() << "GATELIGHT_FLIP_PAIR is not set";
  const Picture reference = read_image(std::filesystem::path(folder) / "tree-ref.png");
  const Picture test = read_image(std::filesystem::path(folder) / "tree-test.png");
  const FlipSummary s = ldr_flip({reference, "tree-ref.png"}, {test, "tree-test.png"}).summary;
  // nv-flip/src/lib.rs there.
  EXPECT_NEAR(s.mean, 0.133285, 1e-4);
  EXPECT_NEAR(s.first_quartile, 0.184924, 1e-4);
  EXPECT_NEAR(s.weighted_median, 0.333241, 1e-4);
  EXPECT_NEAR(s.third_quartile, 0.503441, 1e-4);
  EXPECT_NEAR(s.max, 0.983044, 1e-4);
  EXPECT_EQ(s.min, 0.0);
}

}  // namespace
}  // namespace gatelight::renderer
