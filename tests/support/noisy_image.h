#pragma once
// A picture of two surfaces in smooth light, for denoisers.

#include <cmath>
#include <random>
#include <vector>

#include "renderer/denoise/denoiser.h"
#include "renderer/denoise/exposure.h"

namespace gatelight::testing {

inline renderer::NoisyImage clean_image(int width, int height) {
  renderer::NoisyImage image{width, height, {}, {}, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool left = x < width / 2;
      const float light = 1.0f + 0.5f * std::sin(0.05f * static_cast<float>(x + y));
      for (const float albedo : {left ? 0.8f : 0.2f, 0.5f, left ? 0.3f : 0.7f}) {
        image.albedo.push_back(albedo);
        image.color.push_back(albedo * light);
      }
      image.normal.insert(image.normal.end(), {0.0f, left ? 0.0f : 1.0f, left ? 1.0f : 0.0f});
    }
  }
  return image;
}

/// The same with noise of half the light, and a little in the guides.
inline renderer::NoisyImage noisy_image(int width, int height, unsigned seed = 1) {
  renderer::NoisyImage image = clean_image(width, height);
  std::mt19937 random(seed);
  std::gamma_distribution<float> light(4.0f, 0.25f);
  std::normal_distribution<float> guide(0.0f, 0.02f);
  for (std::size_t i = 0; i < image.color.size(); i += 3) {
    const float noise = light(random);
    for (std::size_t c = i; c < i + 3; ++c) {
      image.color[c] *= noise;
      image.albedo[c] += guide(random);
      image.normal[c] += guide(random);
    }
  }
  return image;
}

/// Reads rows of a plane, which must outlive the result.
inline renderer::ReadRows rows_of(const std::vector<float>& plane, int width, int channels = 3) {
  return [&plane, row = static_cast<std::ptrdiff_t>(width) * channels](int first, int end) {
    return std::vector<float>(plane.begin() + first * row, plane.begin() + end * row);
  };
}

/// The root of the mean square of the difference.
inline double deviation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(static_cast<double>(a[i] - b[i]), 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace gatelight::testing
