#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/metrics/compare.h"
#include "renderer/metrics/estimated_error.h"
#include "tests/support/messages.h"
#include "tests/support/rgb_pictures.h"

namespace gatelight::renderer {
namespace {

using gatelight::testing::rgb;
using ::testing::ElementsAre;
using tests::expect_message;

Picture one_pixel(const std::vector<std::string>& channels, std::vector<float> values) {
  Picture picture{.width = 1, .height = 1};
  picture.layers = {{.channels = channels, .values = std::move(values)}};
  return picture;
}

ErrorMetrics compare(const Picture& reference, const Picture& test) {
  return compare_pictures({reference, "ref.exr"}, {test, "test.exr"});
}

TEST(Compare, MetricsMatchTheHandWorkedExample) {
  // Differences: +1, 0, -0.5 | 0, +2, 0.
  const Picture reference = rgb(2, 1, {1.0f, 0.0f, 0.5f, 3.0f, 2.0f, 0.25f});
  const Picture test = rgb(2, 1, {2.0f, 0.0f, 0.0f, 3.0f, 4.0f, 0.25f});
  const ErrorMetrics m = compare(reference, test);
  EXPECT_DOUBLE_EQ(m.mse, (1.0 + 0.25 + 4.0) / 6.0);
  EXPECT_DOUBLE_EQ(m.rel_mse, (1.0 / 1.01 + 0.25 / 0.26 + 4.0 / 4.01) / 6.0);
  EXPECT_DOUBLE_EQ(m.mean_error, 3.5 / 6.0);
  EXPECT_DOUBLE_EQ(m.mean_difference, 2.5 / 6.0);
  EXPECT_DOUBLE_EQ(m.max_error, 2.0);
  EXPECT_DOUBLE_EQ(m.psnr, -10.0 * std::log10(5.25 / 6.0));
  EXPECT_EQ(m.pixels, 2u);
}

TEST(Compare, EqualPicturesHaveNoError) {
  const Picture picture = rgb(1, 2, {1e-6f, 1e6f, 0.0f, -1.0f, 2.0f, 3.0f});
  const ErrorMetrics m = compare(picture, picture);
  EXPECT_EQ(m.mse, 0.0);
  EXPECT_EQ(m.rel_mse, 0.0);
  EXPECT_EQ(m.max_error, 0.0);
  EXPECT_EQ(m.psnr, std::numeric_limits<double>::infinity());
}

TEST(Compare, NonFinitePixelsAreCountedAndLeftOut) {
  const float nan = std::nanf("");
  const float inf = std::numeric_limits<float>::infinity();
  const Picture reference = rgb(4, 1, {1, 1, 1, inf, 0, 0, 5, 5, nan, 2, 2, 2});
  const Picture test = rgb(4, 1, {nan, 1, 1, 0, 0, 0, inf, 5, 5, 2.5f, 2, 2});
  const ErrorMetrics m = compare(reference, test);
  EXPECT_EQ(m.nonfinite_reference, 2u);
  EXPECT_EQ(m.nonfinite_test, 2u);
  EXPECT_EQ(m.pixels, 1u);
  EXPECT_DOUBLE_EQ(m.mse, 0.25 / 3.0);
  EXPECT_DOUBLE_EQ(m.max_error, 0.5);
}

TEST(Compare, WithoutAFinitePixelErrorsAreNaN) {
  const float nan = std::nanf("");
  const Picture reference = rgb(1, 1, {1, 1, 1});
  const Picture test = rgb(1, 1, {nan, 1, 1});
  const ErrorMetrics m = compare(reference, test);
  EXPECT_EQ(m.pixels, 0u);
  for (const double error : {m.mse, m.rel_mse, m.psnr, m.mean_error, m.mean_difference, m.max_error})
    EXPECT_TRUE(std::isnan(error));
  EXPECT_TRUE(std::isnan(squared_bias({{reference, "r"}, {reference, "r"}}, {{test, "t"}, {test, "t"}})));
}

TEST(Compare, DifferencesBeyondFloatAreSummedInDouble) {
  // (1e20)^2 is beyond float; and a small error beside it is not lost to the difference of squares.
  const ErrorMetrics m = compare(rgb(1, 1, {0, 0, 0}), rgb(1, 1, {1e20f, 0, 0}));
  EXPECT_NEAR(m.mse / (1e40 / 3.0), 1.0, 1e-6);
}

TEST(Compare, AlphaIsIgnoredAndOneChannelIsGrey) {
  const Picture rgba = one_pixel({"A", "B", "G", "R"}, {0.1f, 3.0f, 2.0f, 1.0f});
  EXPECT_EQ(compare(rgb(1, 1, {1, 2, 3}), rgba).mse, 0.0);
  EXPECT_EQ(compare(one_pixel({"Y"}, {2.0f}), one_pixel({"Y"}, {2.5f})).mse, 0.25);
}

std::string refusal_to_compare(const Picture& reference, const Picture& test) {
  return tests::refusal<InputError>([&] { compare(reference, test); });
}

TEST(Compare, DifferentSizesNameBothPictures) {
  expect_message(refusal_to_compare(rgb(2, 1, std::vector<float>(6)), rgb(1, 2, std::vector<float>(6))),
                 {"ref.exr", "2x1", "test.exr", "1x2"});
}

TEST(Compare, DifferentRegionsOfOnePictureNameBoth) {
  Picture left = rgb(2, 1, std::vector<float>(6)), right = left;
  left.full_width = right.full_width = 4;
  left.full_height = right.full_height = 1;
  right.x0 = 2;
  expect_message(refusal_to_compare(left, right), {"4x1", "ref.exr", "0,0", "test.exr", "2,0"});
  EXPECT_EQ(refusal_to_compare(right, right), "");
  EXPECT_EQ(refusal_to_compare(rgb(2, 1, std::vector<float>(6)), right), "") << "a PNG of the same region";
}

TEST(Compare, GreyAndColoursAreRefused) {
  const Picture grey = one_pixel({"Y", "A"}, {2.0f, 1.0f}), colours = rgb(1, 1, {2, 2, 2});
  expect_message(refusal_to_compare(grey, colours), {"ref.exr", "test.exr"});
  expect_message(refusal_to_compare(colours, grey), {"ref.exr", "test.exr"});
}

TEST(Compare, APictureWithoutColoursIsRefusedByName) {
  expect_message(refusal_to_compare(rgb(1, 1, {1, 2, 3}), one_pixel({"Z"}, {1.0f})), {"test.exr"});
  expect_message(refusal_to_compare(Picture{.width = 1, .height = 1}, rgb(1, 1, {1, 2, 3})), {"ref.exr"});
  const Picture part = one_pixel({"R", "G", "Z"}, {1, 2, 3});
  expect_message(refusal_to_compare(part, part), {"ref.exr", "R, G, Z"});
}

TEST(ErrorMap, RunsFromBlackToWhiteAndMarksNonFinite) {
  const float nan = std::nanf("");
  const Picture reference = rgb(3, 1, {1, 1, 1, 0, 0, 0, 1, 1, 1});
  const Picture test = rgb(3, 1, {1, 1, 1, 9, 9, 9, 1, nan, 1});
  const Picture map = error_map({reference, "a"}, {test, "b"});
  EXPECT_THAT(map.layers[0].values, ElementsAre(0, 0, 0, 1, 1, 1, 0, 1, 0));
}

struct Case {
  Picture picture{.width = 7, .height = 5};
  Layer values{.channels = {"R", "G", "B"}, .values = std::vector<float>(7 * 5 * 3, 0.0f)};
  Layer errors = values;

  double estimate(int smoothing) const { return estimated_error(picture, values, errors, smoothing); }
};

TEST(ErrorEstimate, IsRelativeToTheValue) {
  Case c;
  std::fill(c.values.values.begin(), c.values.values.end(), 2.0f);
  std::fill(c.errors.values.begin(), c.errors.values.end(), 0.5f);
  for (const int smoothing : {0, 1, 100}) {
    EXPECT_NEAR(c.estimate(smoothing), 0.5 / std::sqrt(4.0 + 1e-2), 1e-6) << smoothing;
  }
}

TEST(ErrorEstimate, IsThatOfCompareInTheDark) {
  Case c;
  EXPECT_EQ(c.estimate(2), 0.0);
  c.errors.values[4] = 1.0f;
  EXPECT_NEAR(c.estimate(0), std::sqrt(1.0 / 1e-2 / (7 * 5 * 3)), 1e-9);
}

TEST(ErrorEstimate, ABrightSampleIsRelativeToItsNeighbourhood) {
  Case c;
  const std::size_t middle = 3 * (2 * 7 + 3);
  c.values.values[middle] = 90.0f;
  c.errors.values[middle] = 90.0f;
  const double count = 7 * 5 * 3;
  EXPECT_NEAR(c.estimate(0), std::sqrt(8100.0 / (8100.0 + 1e-2) / count), 1e-6);
  EXPECT_NEAR(c.estimate(1), std::sqrt(8100.0 / (100.0 + 1e-2) / count), 1e-5);
}

TEST(ErrorEstimate, ChannelsAreSeparateAndNeighbourhoodsEndAtBorders) {
  Case c;
  c.errors.values[0] = 1.0f;     // red of the first pixel
  c.values.values[1] = 1000.0f;  // its green
  c.values.values[3] = 4.0f;     // red of the next pixel
  EXPECT_NEAR(c.estimate(1), std::sqrt(1.0 / (1.0 + 1e-2) / (7 * 5 * 3)), 1e-6)
      << "the mean of four reds is 1";
}

}  // namespace
}  // namespace gatelight::renderer
