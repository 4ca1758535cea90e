#pragma once
// Converts linear light to the bytes that a screen shows.

#include <cstdint>

#include "scene/math.h"

namespace gatelight::renderer {

enum class Tonemap : std::uint8_t {
  none,    ///< values above 1 are clamped
  filmic,  ///< a smooth shoulder and toe
};

/// K. Narkowicz's fit of the ACES reference curve (2016): x(2.51x + 0.03) / (x(2.43x + 0.59) + 0.14), clamped
/// to [0, 1]. Input and output are linear; each channel is separate.
float filmic(float x);

/// The byte of one channel: x times exposure_scale, through the curve and sRGB, rounded to nearest.
std::uint8_t display_byte(float x, float exposure_scale, Tonemap tonemap);

/// 2^stops, the exposure_scale of display_byte().
float exposure_scale(float stops);

}  // namespace gatelight::renderer
