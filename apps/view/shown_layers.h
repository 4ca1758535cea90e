#pragma once
// Layers of a picture as a screen shows them.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/image/display.h"
#include "renderer/image/picture.h"

namespace gatelight::apps {

/// Red, green and blue of each pixel, rows from the top. `layer`: its name, empty for the picture itself.
/// Radiance is shown with exposure and curve, albedo as it reflects white light, directions from -1 to 1,
/// numbers of objects as colours; errors and distances by a scale from dark (none) to bright (much). Throws
/// BadOption for a layer that the picture has not, and what displayed() throws.
std::vector<std::uint8_t> layer_bytes(const renderer::Picture& picture, const std::string& layer,
                                      const renderer::DisplayOptions& display);

/// Numbers of pixels by brightness as they are shown, for red, green and blue: three times 64 counts.
std::vector<int> histogram(const std::vector<std::uint8_t>& bytes);

}  // namespace gatelight::apps
