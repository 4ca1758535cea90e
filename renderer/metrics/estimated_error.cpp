#include "renderer/metrics/estimated_error.h"

#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/parallel/loops.h"
#include "renderer/image/box_filter.h"
#include "renderer/metrics/compare.h"

namespace gatelight::renderer {

double estimated_error(const Picture& picture, const Layer& values, const Layer& errors, int smoothing) {
  assert(values.values.size() == errors.values.size() && smoothing >= 0);
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  const std::size_t channels = values.channels.size();
  std::vector<double> sums(height);  // of rows, so that the result is the same for any number of threads
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<float> usual(width * height);
    for (std::size_t p = 0; p < usual.size(); ++p) usual[p] = values.values[p * channels + c];
    box_filter(usual, picture.width, picture.height, smoothing);
    for_each(height, [&](std::size_t y) {
      for (std::size_t p = y * width; p < (y + 1) * width; ++p) {
        const double value = usual[p], error = errors.values[p * channels + c];
        sums[y] += error * error / (value * value + kRelMseEpsilon);
      }
    });
  }
  const auto count = static_cast<double>(width * height * channels);
  return std::sqrt(std::accumulate(sums.begin(), sums.end(), 0.0) / count);
}

}  // namespace gatelight::renderer
