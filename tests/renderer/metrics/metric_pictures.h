#pragma once
// Pictures for the metrics, and what all metrics have in common.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "renderer/image/tonemap.h"
#include "tests/support/rgb_pictures.h"
#include "tests/support/statistics.h"

namespace gatelight::testing {

/// Blotches with edges, points and noise: bright and dark ones, with noise up to the given one, lifted.
inline renderer::Picture blotched(int width, int height, std::uint64_t seed, float bright, float dark,
                                  float noise, float lift = 0.0f) {
  Random random(seed);
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c)
        values.push_back(((x / 5 + y / 4 + c) % 3 == 0 ? bright : dark) + noise * random.uniform_float() +
                         lift);
    }
  }
  return rgb(width, height, std::move(values));
}

template <class Change>
renderer::Picture changed(renderer::Picture picture, const Change& change) {
  for (float& value : picture.layers[0].values) value = change(value);
  return picture;
}

/// Expects that a metric shows both pictures with the exposure and the curve of its options before it
/// compares them. measure(a, b, options) returns something that can be compared.
template <class Options, class Measure>
void expect_shown_pictures(const renderer::Picture& a, const renderer::Picture& b, const Measure& measure) {
  const auto doubled = [](float x) { return 2.0f * x; };
  const auto filmic = [](float x) { return renderer::filmic(x); };
  EXPECT_EQ(measure(a, b, Options{.exposure = 1.0f}),
            measure(changed(a, doubled), changed(b, doubled), Options{}));
  EXPECT_EQ(measure(a, b, Options{.tonemap = renderer::Tonemap::filmic}),
            measure(changed(a, filmic), changed(b, filmic), Options{}));
  EXPECT_NE(measure(a, b, Options{.tonemap = renderer::Tonemap::filmic}), measure(a, b, Options{}));
}

/// Expects that a measurement has the same bits for one thread and for seven.
template <class Measure>
void expect_same_for_any_threads(const Measure& measure) {
  const auto with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return measure();
  };
  EXPECT_EQ(with(1), with(7));
}

}  // namespace gatelight::testing
