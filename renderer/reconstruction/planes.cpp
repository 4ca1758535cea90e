#include "renderer/reconstruction/planes.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace gatelight::renderer {
namespace {

constexpr int kTogether = 16;  // of kernel_regression.h

/// No pixel is farther than two from a window's centre.
int windows(int pixels) {
  return (pixels + window::kStride - 1) / window::kStride;
}

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

void box_filter(Plane& plane, int width, int height, int radius) {
  Plane rows(plane.size());
  const auto w = static_cast<std::size_t>(width);
  tbb::parallel_for(0, height, [&](int y) {
    const std::size_t at = static_cast<std::size_t>(y) * w;
    box_line(&plane[at], &rows[at], 1, width, radius);
  });
  tbb::parallel_for(0, height, [&](int y) {
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

DealtLayout::DealtLayout(int width, int height)
    : width_(width),
      height_(height),
      columns_((windows(width) + kTogether - 1) / kTogether * kTogether),
      rows_(windows(height)),
      phase_(static_cast<std::size_t>(columns_ + 2 * window::kMargin / window::kStride + 1)),
      row_(phase_ * window::kStride),
      size_(row_ * static_cast<std::size_t>((rows_ + 1) * window::kStride + 2 * window::kMargin)) {}

Plane DealtLayout::deal_clamped(const Plane& plane) const {
  Plane dealt(size_, 0.0f);
  tbb::parallel_for(-window::kMargin, height_ + window::kMargin, [&](int y) {
    const float* const row =
        &plane[static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * static_cast<std::size_t>(width_)];
    for (int x = -window::kMargin; x < width_ + window::kMargin; ++x)
      dealt[at(x, y)] = row[std::clamp(x, 0, width_ - 1)];
  });
  return dealt;
}

Plane DealtLayout::deal(const Plane& plane) const {
  Plane dealt(size_, 0.0f);
  tbb::parallel_for(0, height_, [&](int y) {
    const float* const row = &plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_)];
    for (int x = 0; x < width_; ++x) dealt[at(x, y)] = row[x];
  });
  return dealt;
}

}  // namespace gatelight::renderer
