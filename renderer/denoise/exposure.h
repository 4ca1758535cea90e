#pragma once
// Measures the brightness of a picture, for the input scale of a filter.

#include <functional>
#include <vector>

namespace gatelight::renderer {

/// Rows first <= y < end of a picture: 3 floats a pixel.
using ReadRows = std::function<std::vector<float>(int first, int end)>;

/// The factor by which the geometric mean of a picture's luminance becomes 0.18, over bins of 16x16 pixels
/// that are not black; 1 where all are. Open Image Denoise chooses its input scale in this way where none is
/// given.
float exposure_of(int width, int height, const ReadRows& color);

}  // namespace gatelight::renderer
