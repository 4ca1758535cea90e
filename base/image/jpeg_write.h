#pragma once
// Encodes JPEG pictures with libjpeg.

#include <cstdint>
#include <vector>

namespace gatelight {

/// `rgb` holds width * height * 3 values, rows from the top, at most 65500 a side. `quality` is libjpeg's, 0
/// to 100. Colour has full resolution. Throws std::runtime_error with libjpeg's message.
std::vector<std::uint8_t> encode_jpeg(const std::vector<std::uint8_t>& rgb, int width, int height,
                                      int quality);

}  // namespace gatelight
