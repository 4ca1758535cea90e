#pragma once
// Pictures whose truth is known, for reconstruction: two surfaces under smooth light, and samples of it.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "renderer/reconstruction/reconstruct.h"

namespace gatelight::renderer {

struct Made {
  SampledPicture samples;
  std::vector<double> truth;
  std::vector<double> mean;  ///< of all samples
};

/// A floor and a wall, whose light changes smoothly; `stripes` of it are told by no guide. Samples are gamma
/// distributed: their mean is the truth, their standard deviation `noise` times it.
inline Made make_picture(int width, int height, int spp, double noise, double stripes = 0.0) {
  Made made;
  SampledPicture& s = made.samples;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  s.width = width;
  s.height = height;
  for (auto& half : s.halves) half.color.resize(3 * pixels), half.variance.resize(3 * pixels);
  s.counts.assign(pixels, static_cast<float>(spp));
  s.coverage.assign(pixels, 1.0f);
  for (auto* plane : {&s.albedo, &s.normal}) plane->resize(3 * pixels);
  s.depth.resize(pixels);
  std::mt19937 random(7);
  for (std::size_t p = 0; p < pixels; ++p) {
    const int x = static_cast<int>(p) % width, y = static_cast<int>(p) / width;
    const bool floor = 2 * y + x > height;
    s.normal[3 * p + (floor ? 1 : 2)] = 1.0f;
    s.depth[p] = 5.0f - (floor ? 2.0f * static_cast<float>(y) / static_cast<float>(height) : 0.0f);
    for (std::size_t c = 0; c < 3; ++c) {
      const float albedo = (x / 8 + y / 8) % 2 == 0 ? 0.2f + 0.2f * static_cast<float>(c) : 0.7f;
      s.albedo[3 * p + c] = albedo;
      const double light = 1.5 + std::sin(0.05 * x + static_cast<double>(c)) + (floor ? 0.02 * y : 0.5) +
                           (x / 3 % 2 == 0 ? stripes : 0.0);
      const double truth = light * static_cast<double>(albedo);
      made.truth.push_back(truth);
      double sums[2] = {0.0, 0.0}, squares[2] = {0.0, 0.0}, counts[2] = {0.0, 0.0};
      const double shape = 1.0 / (noise * noise);
      std::gamma_distribution<double> sample(shape, truth / shape);
      for (int i = 0; i < spp; ++i) {
        const double v = sample(random);
        sums[i % 2] += v, squares[i % 2] += v * v, counts[i % 2] += 1.0;
      }
      made.mean.push_back((sums[0] + sums[1]) / spp);
      for (std::size_t h = 0; h < 2; ++h) {
        const double n = counts[h];
        if (n > 0.0) s.halves[h].color[3 * p + c] = static_cast<float>(sums[h] / n);
        if (n > 1.0) {
          const double variance = (squares[h] - sums[h] * sums[h] / n) / (n * (n - 1.0));
          s.halves[h].variance[3 * p + c] = static_cast<float>(variance);
        }
      }
    }
  }
  return made;
}

inline void expect_a_picture(const Reconstruction& result, std::size_t pixels) {
  ASSERT_EQ(result.color.size(), 3 * pixels);
  ASSERT_EQ(result.error.size(), 3 * pixels);
  for (const auto* values : {&result.color, &result.error}) {
    for (const float value : *values) ASSERT_TRUE(std::isfinite(value) && value >= 0.0f) << value;
  }
}

}  // namespace gatelight::renderer
