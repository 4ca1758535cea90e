#include "renderer/metrics/temporal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "renderer/image/srgb.h"
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

using Sequence = std::vector<Picture>;

/// The pixels have these values of the screen in all channels.
Picture shown(int width, int height, const std::function<float(int, int)>& value) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) values.insert(values.end(), 3, srgb_to_linear(value(x, y)));
  }
  return rgb(width, height, std::move(values));
}

Picture noise(int width, int height, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> values;
  for (int i = 0; i < 3 * width * height; ++i) values.push_back(1.3f * random.uniform_float() - 0.1f);
  return rgb(width, height, std::move(values));
}

TemporalDeviation measure(const Sequence& reference, const Sequence& test,
                          const TemporalOptions& options = {}) {
  TemporalMeter meter(options);
  for (std::size_t i = 0; i < reference.size(); ++i)
    meter.add({reference[i], "ref.exr"}, {test[i], "test.exr"});
  return meter.deviation().value();
}

/// The definition as it stands, with a Gaussian of two dimensions.
TemporalDeviation plain(const Sequence& reference, const Sequence& test) {
  const int width = reference[0].width, height = reference[0].height;
  const auto at = [&](const Picture& picture, int x, int y, int c) {
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
    const auto i = static_cast<std::size_t>(3 * (y * width + x) + c);
    const double light = std::clamp(static_cast<double>(picture.layers[0].values[i]), 0.0, 1.0);
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
  };
  double low_sum = 0.0, high_sum = 0.0, values = 0.0;
  for (std::size_t n = 1; n < reference.size(); ++n) {
    const auto deviation = [&](int x, int y, int c) {
      return at(test[n], x, y, c) - at(test[n - 1], x, y, c) -
             (at(reference[n], x, y, c) - at(reference[n - 1], x, y, c));
    };
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < 3; ++c) {
          double low = 0.0, weights = 0.0;
          for (int dy = -18; dy <= 18; ++dy) {
            for (int dx = -18; dx <= 18; ++dx) {
              const double weight = std::exp(-(dx * dx + dy * dy) / (2.0 * 6.0 * 6.0));
              weights += weight;
              low += weight * deviation(x + dx, y + dy, c);
            }
          }
          low /= weights;
          const double high = deviation(x, y, c) - low;
          low_sum += low * low;
          high_sum += high * high;
          values += 1.0;
        }
      }
    }
  }
  return {.low = std::sqrt(low_sum / values), .high = std::sqrt(high_sum / values)};
}

TEST(Temporal, AgreesWithThePlainFormula) {
  // Smaller than the Gaussian, a row, a column.
  for (const auto& [width, height] : {std::pair{13, 9}, {40, 1}, {1, 21}}) {
    const Sequence reference{noise(width, height, 1), noise(width, height, 2), noise(width, height, 3)};
    const Sequence test{noise(width, height, 4), noise(width, height, 5), noise(width, height, 6)};
    const TemporalDeviation expected = plain(reference, test);
    const TemporalDeviation measured = measure(reference, test);
    EXPECT_NEAR(measured.low, expected.low, 1e-6) << width << "x" << height;
    EXPECT_NEAR(measured.high, expected.high, 1e-6) << width << "x" << height;
  }
}

TEST(Temporal, AFlickerOfTheWholePictureIsLow) {
  const auto even = [](float value) { return shown(30, 20, [=](int, int) { return value; }); };
  const Sequence still(4, even(0.5f));
  const TemporalDeviation flicker = measure(still, {even(0.5f), even(0.6f), even(0.5f), even(0.6f)});
  EXPECT_NEAR(flicker.low, 0.1, 1e-6);
  EXPECT_NEAR(flicker.high, 0.0, 1e-12);
  // One step among three pairs.
  const TemporalDeviation step = measure(still, {even(0.5f), even(0.5f), even(0.6f), even(0.6f)});
  EXPECT_NEAR(step.low, 0.1 / std::sqrt(3.0), 1e-6);
}

TEST(Temporal, AFlickerOfPixelsIsHigh) {
  const auto checks = [](int odd) {
    return shown(200, 200, [=](int x, int y) { return (x + y) % 2 == odd ? 0.55f : 0.45f; });
  };
  const Sequence still(3, shown(200, 200, [](int, int) { return 0.5f; }));
  const TemporalDeviation deviation = measure(still, {checks(0), checks(1), checks(0)});
  // The repeated edges leave a little in the corners.
  EXPECT_LT(deviation.low, 0.002);
  EXPECT_NEAR(deviation.high, 0.1, 1e-3);
}

TEST(Temporal, ChangesThatTheReferenceSharesCountNothing) {
  // An edge that moves by 3 pixels a frame.
  const auto moved = [](int frame) {
    return shown(50, 30, [=](int x, int) { return x < 3 * frame ? 0.9f : 0.2f; });
  };
  const Sequence moving{moved(1), moved(2), moved(5)};
  const TemporalDeviation same = measure(moving, moving);
  EXPECT_EQ(same.low, 0.0);
  EXPECT_EQ(same.high, 0.0);
  const TemporalDeviation halted = measure(moving, Sequence(3, moved(1)));
  EXPECT_GT(halted.low, 0.1);
  EXPECT_GT(halted.high, 0.1);

  // A test that is wrong by the same in all frames does not flicker.
  const auto brighter = [](const Picture& picture) {
    return gatelight::testing::changed(
        picture, [](float value) { return srgb_to_linear(linear_to_srgb(value) + 0.05f); });
  };
  const TemporalDeviation offset =
      measure(moving, {brighter(moving[0]), brighter(moving[1]), brighter(moving[2])});
  EXPECT_LT(offset.low, 1e-6);
  EXPECT_LT(offset.high, 1e-6);
}

TEST(Temporal, RadianceIsShownWithExposureAndCurve) {
  gatelight::testing::expect_shown_pictures<TemporalOptions>(
      noise(20, 15, 2), noise(20, 15, 4),
      [](const Picture& a, const Picture& b, const TemporalOptions& options) {
        const Picture black = uniform(20, 15, {0, 0, 0});
        return measure({black, a}, {black, b}, options).high;
      });
}

TEST(Temporal, OneFrameHasNone) {
  TemporalMeter meter;
  EXPECT_FALSE(meter.deviation());
  const Picture picture = uniform(2, 2, {1, 1, 1});
  meter.add({picture, "ref.exr"}, {picture, "test.exr"});
  EXPECT_FALSE(meter.deviation());
  meter.add({picture, "ref.exr"}, {picture, "test.exr"});
  EXPECT_TRUE(meter.deviation());
}

TEST(Temporal, TheSameBitsForAnyNumberOfThreads) {
  const Sequence a{noise(50, 90, 1), noise(50, 90, 2), noise(50, 90, 3)};
  const Sequence b{noise(50, 90, 4), noise(50, 90, 5), noise(50, 90, 6)};
  gatelight::testing::expect_same_for_any_threads([&] {
    const TemporalDeviation deviation = measure(a, b);
    return std::pair(deviation.low, deviation.high);
  });
}

TEST(Temporal, RefusesFramesThatDoNotFit) {
  const Picture good = uniform(4, 3, {1, 1, 1});
  TemporalMeter meter;
  meter.add({good, "ref-0.exr"}, {good, "test-0.exr"});
  const auto refusal = [&](const Picture& reference, const Picture& test) {
    return tests::refusal<InputError>([&] { meter.add({reference, "ref-1.exr"}, {test, "test-1.exr"}); });
  };
  const Picture wide = uniform(5, 3, {1, 1, 1});
  expect_message(refusal(wide, wide), {"ref-0.exr", "4x3", "ref-1.exr", "5x3"});
  expect_message(refusal(good, wide), {"ref-1.exr", "4x3", "test-1.exr", "5x3"});
  Picture bad = good;
  bad.layers[0].values[4] = std::numeric_limits<float>::infinity();
  expect_message(refusal(good, bad), {"test-1.exr", "1", "temporal"});
  // Frames that were refused count nothing.
  meter.add({good, "ref-1.exr"}, {good, "test-1.exr"});
  EXPECT_EQ(meter.deviation().value().low, 0.0);
}

}  // namespace
}  // namespace gatelight::renderer
