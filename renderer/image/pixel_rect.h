#pragma once

#include <cstddef>

namespace gatelight::renderer {

/// The pixels x0 <= x < x1, y0 <= y < y1 of a picture.
struct PixelRect {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  /// The number of a pixel of the picture that is in the rectangle, in rows from the top.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width()) +
           static_cast<std::size_t>(x - x0);
  }

  bool operator==(const PixelRect&) const = default;
};

}  // namespace gatelight::renderer
