#pragma once
// Pictures as planes of floats, one for each channel, and their order for the kernel.

#include <vector>

#include "renderer/reconstruction/kernels.h"

namespace gatelight::renderer {

/// A channel, row by row.
using Plane = std::vector<float>;

/// Where the pixels of a picture lie in planes whose columns are dealt to phases (BandView).
class DealtLayout {
 public:
  DealtLayout(int width, int height);

  int columns() const { return columns_; }  ///< of windows, with those that fill the last vector
  int rows() const { return rows_; }        ///< of windows
  std::size_t row() const { return row_; }
  std::size_t phase() const { return phase_; }
  std::size_t size() const { return size_; }
  std::size_t at(int x, int y) const {
    x += window::kMargin;
    return static_cast<std::size_t>(y + window::kMargin) * row_ +
           static_cast<std::size_t>(x % window::kStride) * phase_ +
           static_cast<std::size_t>(x / window::kStride);
  }

  /// Beyond its border a picture goes on with the nearest pixel.
  Plane deal_clamped(const Plane& plane) const;
  /// Beyond its border is 0.
  Plane deal(const Plane& plane) const;

 private:
  int width_;
  int height_;
  int columns_;
  int rows_;
  std::size_t phase_;
  std::size_t row_;
  std::size_t size_;
};

}  // namespace gatelight::renderer
