#pragma once
// Means of squares of pixels.

#include <vector>

namespace gatelight::renderer {

/// Replaces each value of a channel, row by row, by the mean of the square of `radius` pixels around it, as
/// far as it is in the picture. Runs in the caller's arena.
void box_filter(std::vector<float>& plane, int width, int height, int radius);

}  // namespace gatelight::renderer
