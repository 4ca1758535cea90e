#pragma once
// Pictures by hand, for the metrics.

#include <array>
#include <utility>
#include <vector>

#include "renderer/image/picture.h"

namespace gatelight::testing {

/// values: red, green, blue of the pixels, row by row.
inline renderer::Picture rgb(int width, int height, std::vector<float> values) {
  renderer::Picture picture{.width = width, .height = height};
  picture.layers = {{.channels = {"R", "G", "B"}, .values = std::move(values)}};
  return picture;
}

inline renderer::Picture uniform(int width, int height, std::array<float, 3> color) {
  std::vector<float> values;
  for (int i = 0; i < width * height; ++i) values.insert(values.end(), color.begin(), color.end());
  return rgb(width, height, std::move(values));
}

}  // namespace gatelight::testing
