#pragma once
// Moments of a picture whose pixels are independent estimates of the same number.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "renderer/image/picture.h"
#include "renderer/render.h"
#include "tests/support/statistics.h"

namespace gatelight::testing {

/// One channel of the beauty layer.
inline Moments channel_moments(const renderer::Picture& picture, std::size_t channel) {
  Moments moments;
  const std::vector<float>& values = picture.layers[0].values;
  for (std::size_t i = channel; i < values.size(); i += 3) moments.add(static_cast<double>(values[i]));
  return moments;
}

/// All channels of the beauty layer.
inline Moments moments_of(const renderer::Picture& picture) {
  Moments moments;
  for (const float value : picture.layers[0].values) moments.add(static_cast<double>(value));
  return moments;
}

inline constexpr std::uint32_t kSeeds = 24;

/// The means of pictures with the seeds 1 to kSeeds.
inline Moments means_of_seeds(const scene::Scene& scene, renderer::RenderOptions options) {
  Moments means;
  for (options.seed = 1; options.seed <= kSeeds; ++options.seed)
    means.add(moments_of(renderer::Renderer(scene, options).render()).mean());
  return means;
}

/// Expects two such means to be equal within their noise, and the noise to be below this part of the first.
inline void expect_equal_means(const Moments& a, const Moments& b, double largest_error = 0.02) {
  const double error = std::hypot(a.standard_error(), b.standard_error());
  EXPECT_LT(error, largest_error * a.mean());
  EXPECT_GT(student_two_sided((a.mean() - b.mean()) / error, 2.0 * (kSeeds - 1)), 1e-4)
      << a.mean() << " and " << b.mean() << ", error " << error;
}

}  // namespace gatelight::testing
