#include "renderer/film/scale_down.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/parallel/loops.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

std::size_t size(int x) {
  return static_cast<std::size_t>(x);
}

}  // namespace

ScaleDown::ScaleDown(int factor, PixelFilter filter, float width) : factor_(factor) {
  if (factor == 1) {
    reach_ = 0;
    weights_ = {1.0f};
    return;
  }
  // A narrower filter would miss the middles of the larger picture's pixels.
  const double half = std::max(0.5 * static_cast<double>(resolve_filter_width(filter, width)), 0.5) * factor;
  reach_ = std::max(static_cast<int>(std::ceil(half - 0.5 * factor)), 0);
  for (int i = -reach_; i < factor + reach_; ++i) {
    const double x = (i + 0.5 - 0.5 * factor) / half;
    weights_.push_back(std::abs(x) <= 1.0 ? static_cast<float>(std::max(filter_value(filter, x), 0.0))
                                          : 0.0f);
  }
}

std::vector<float> ScaleDown::scale(std::span<const float> values, int channels, int width, int height,
                                    int top, int begin, int end) const {
  const int columns = width / factor_;
  const std::size_t row = size(width) * size(channels), small_row = size(columns) * size(channels);
  std::vector<float> result(size(end - begin) * small_row);
  // Calls add(pixel, weight) for the pixels of the large picture around a pixel of the small one.
  const auto gather = [&](int small, int limit, const auto& add) {
    const int first = small * factor_ - reach_;
    float sum = 0.0f;
    for (int i = std::max(-first, 0); i < static_cast<int>(weights_.size()) && first + i < limit; ++i)
      sum += weights_[size(i)];
    for (int i = std::max(-first, 0); i < static_cast<int>(weights_.size()) && first + i < limit; ++i)
      add(first + i, weights_[size(i)] / sum);
  };
  for_each(size(end - begin), [&](std::size_t line) {
    const int y = begin + static_cast<int>(line);
    std::vector<float> sums(row);
    gather(y, height, [&](int from, float weight) {
      assert(from >= top && size(from - top + 1) * row <= values.size());
      const float* const in = &values[size(from - top) * row];
      for (std::size_t i = 0; i < row; ++i) sums[i] += weight * in[i];
    });
    float* const out = &result[size(y - begin) * small_row];
    for (int x = 0; x < columns; ++x) {
      gather(x, width, [&](int from, float weight) {
        for (int c = 0; c < channels; ++c)
          out[size(x) * size(channels) + size(c)] += weight * sums[size(from) * size(channels) + size(c)];
      });
    }
  });
  return result;
}

}  // namespace gatelight::renderer
