#pragma once

namespace gatelight::renderer {

/// The pixels x0 <= x < x1, y0 <= y < y1 of a picture.
struct PixelRect {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

}  // namespace gatelight::renderer
