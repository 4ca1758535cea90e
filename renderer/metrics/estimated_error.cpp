#include "renderer/metrics/estimated_error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "renderer/metrics/compare.h"

namespace gatelight::renderer {
namespace {

/// Replaces each of the `length` values that lie `stride` apart by the mean of those around it.
void smooth_line(float* values, std::size_t length, std::size_t stride, std::size_t radius,
                 std::vector<double>& sums) {
  sums.resize(length + 1);
  for (std::size_t i = 0; i < length; ++i) sums[i + 1] = sums[i] + static_cast<double>(values[i * stride]);
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t begin = i - std::min(i, radius), end = std::min(i + radius + 1, length);
    values[i * stride] = static_cast<float>((sums[end] - sums[begin]) / static_cast<double>(end - begin));
  }
}

void smooth(std::vector<float>& values, std::size_t width, std::size_t height, std::size_t channels,
            std::size_t radius) {
  const auto each_line = [&](std::size_t lines, std::size_t length, std::size_t step, std::size_t stride) {
    tbb::parallel_for(std::size_t{0}, lines, [&](std::size_t line) {
      std::vector<double> sums;
      for (std::size_t c = 0; c < channels; ++c)
        smooth_line(&values[line * step + c], length, stride, radius, sums);
    });
  };
  each_line(height, width, width * channels, channels);
  each_line(width, height, channels, width * channels);
}

}  // namespace

double estimated_error(const Picture& picture, const Layer& values, const Layer& errors, int smoothing) {
  assert(values.values.size() == errors.values.size() && smoothing >= 0);
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  const std::size_t row = width * values.channels.size();
  std::vector<float> usual = values.values;
  if (smoothing > 0)
    smooth(usual, width, height, values.channels.size(), static_cast<std::size_t>(smoothing));
  std::vector<double> sums(height);  // of rows, so that the result is the same for any number of threads
  tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
    for (std::size_t i = y * row; i < (y + 1) * row; ++i) {
      const double value = usual[i], error = errors.values[i];
      sums[y] += error * error / (value * value + kRelMseEpsilon);
    }
  });
  return std::sqrt(std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(height * row));
}

}  // namespace gatelight::renderer
