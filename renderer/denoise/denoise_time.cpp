#include "renderer/denoise/denoise_time.h"

#include <algorithm>
#include <cstdint>

#include "base/clock.h"

namespace gatelight::renderer {
namespace {

/// Large enough that the time grows with the pixels.
constexpr int kEdge = 256;
/// Factor for the estimate of the error, scaling, and memory that is touched for the first time.
constexpr double kMore = 1.4;

NoisyImage image_of_noise(int width, int height) {
  std::uint32_t state = 1;
  std::vector<float> noise(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (float& value : noise) {
    state = state * 1664525u + 1013904223u;
    value = static_cast<float>(state >> 8) * 0x1p-24f;
  }
  return {width, height, noise, noise, noise};
}

}  // namespace

double expect_denoise_seconds(Denoiser& denoiser, const DenoiseOptions& options, int width, int height) {
  NoisyImage image = image_of_noise(std::min(width, kEdge), std::min(height, kEdge));
  const double share =
      static_cast<double>(image.width) * image.height / (static_cast<double>(width) * height);
  const FilterOptions filter{.prefilter = options.prefilter};
  denoiser.filter(image, filter);  // the first time networks are set up
  const Clock::time_point start = Clock::now();
  denoiser.filter(image, filter);
  return kMore * seconds_since(start) / share;
}

}  // namespace gatelight::renderer
