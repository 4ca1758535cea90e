#pragma once
// Encodes PNG files with libpng.

#include <cstdint>
#include <span>
#include <vector>

namespace gatelight {

/// `pixels` holds width * height * channels display values in sRGB, rows from the top; channels is 3, or 4
/// with straight alpha. The files have 8 or 16 bits, as the type of a value. Throws std::runtime_error with
/// libpng's message.
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels, int width, int height,
                                     int channels);
std::vector<std::uint8_t> encode_png(std::span<const std::uint16_t> pixels, int width, int height,
                                     int channels);

}  // namespace gatelight
