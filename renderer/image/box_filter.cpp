#include "renderer/image/box_filter.h"

#include <algorithm>

#include "base/parallel/loops.h"

namespace gatelight::renderer {
namespace {

/// Means along lines of `count` values that lie `step` apart.
void box_line(const float* from, float* to, std::size_t step, int count, int radius) {
  for (int i = 0; i < count; ++i) {
    const int first = std::max(i - radius, 0), end = std::min(i + radius + 1, count);
    float sum = 0.0f;
    for (int k = first; k < end; ++k) sum += from[static_cast<std::size_t>(k) * step];
    to[static_cast<std::size_t>(i) * step] = sum / static_cast<float>(end - first);
  }
}

}  // namespace

void box_filter(std::vector<float>& plane, int width, int height, int radius) {
  std::vector<float> rows(plane.size());
  const auto w = static_cast<std::size_t>(width);
  for_each(static_cast<std::size_t>(height), [&](std::size_t line) {
    const auto y = static_cast<int>(line);
    const std::size_t at = static_cast<std::size_t>(y) * w;
    box_line(&plane[at], &rows[at], 1, width, radius);
  });
  for_each(static_cast<std::size_t>(height), [&](std::size_t line) {
    const auto y = static_cast<int>(line);
    const int first = std::max(y - radius, 0), end = std::min(y + radius + 1, height);
    float* const to = &plane[static_cast<std::size_t>(y) * w];
    std::fill(to, to + width, 0.0f);
    for (int k = first; k < end; ++k) {
      const float* const from = &rows[static_cast<std::size_t>(k) * w];
      for (int x = 0; x < width; ++x) to[x] += from[x];
    }
    const float over = 1.0f / static_cast<float>(end - first);
    for (int x = 0; x < width; ++x) to[x] *= over;
  });
}

}  // namespace gatelight::renderer
