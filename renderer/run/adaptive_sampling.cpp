#include "renderer/run/adaptive_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "renderer/image/box_filter.h"

namespace gatelight::renderer {
namespace {

constexpr int kFirstDensity = 2;
constexpr int kNextDensity = 4;  // times the one before
/// Noise and brightness are smoothed over this many pixels around each, in each direction.
constexpr int kDensitySmoothing = 3;
/// Where noise falls with the root of the number of samples, its sum over the pixels is least with numbers in
/// proportion to this power of it. The mean of squares asks for the first power, but sees few pixels alone.
constexpr double kPower = 2.0 / 3.0;
/// No pixel gets less or more than these times what is usual.
constexpr double kLeast = 0.25, kMost = 8.0;
/// Noise counts relative to brightness plus this share of the picture's mean: in the dark it is not seen.
constexpr double kDark = 1.0;
/// In the same unit. Squares stay in single precision.
constexpr double kBrightest = 1e15;

}  // namespace

int next_density(const RenderOptions& options, int samples) {
  if (!options.adaptive || !options.reconstruct) return std::numeric_limits<int>::max();
  std::int64_t at = kFirstDensity;
  while (at <= samples) at *= kNextDensity;
  return static_cast<int>(std::min<std::int64_t>(at, std::numeric_limits<int>::max()));
}

SampleDensity make_density(const PixelRect& rect, const Reconstruction& finished) {
  const std::size_t pixels = finished.noise[0].size();
  const auto smooth = [&](std::vector<float>& plane) {
    box_filter(plane, rect.width(), rect.height(), kDensitySmoothing);
  };
  const auto mean = [&](const auto& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(pixels);
  };
  std::array<std::vector<float>, 2> values;
  for (const std::size_t h : {0u, 1u}) {
    // By the other half.
    const std::vector<float>&color = finished.halves[1 - h], &noise = finished.noise[1 - h];
    const double of_picture = mean(color) / 3.0 + std::numeric_limits<double>::min();
    std::vector<float> brightness(pixels), square(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
      const auto relative = [&](double value) { return std::min(value / of_picture, kBrightest); };
      const double sum = static_cast<double>(color[3 * p]) + static_cast<double>(color[3 * p + 1]) +
                         static_cast<double>(color[3 * p + 2]);
      brightness[p] = static_cast<float>(relative(sum / 3.0));
      square[p] = static_cast<float>(std::pow(relative(static_cast<double>(noise[p])), 2));
    }
    smooth(brightness);
    smooth(square);
    std::vector<float>& value = values[h];
    value.resize(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
      value[p] = static_cast<float>(std::pow(
          std::sqrt(static_cast<double>(square[p])) / (static_cast<double>(brightness[p]) + kDark), kPower));
    }
    const double usual = mean(value);
    const auto least = static_cast<float>(kLeast * usual), most = static_cast<float>(kMost * usual);
    for (float& v : value) v = std::clamp(v, least, most);
  }
  return {rect, std::move(values)};
}

bool density_due(const Film& film, int samples, const RenderOptions& options) {
  return samples > 0 && next_density(options, samples - 1) == samples && !film.new_density();
}

}  // namespace gatelight::renderer
