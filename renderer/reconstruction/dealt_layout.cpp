#include "renderer/reconstruction/dealt_layout.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace gatelight::renderer {
namespace {

constexpr int kTogether = 16;  // of kernel_regression.h

/// No pixel is farther than two from a window's centre.
int windows(int pixels) {
  return (pixels + window::kStride - 1) / window::kStride;
}

}  // namespace

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
