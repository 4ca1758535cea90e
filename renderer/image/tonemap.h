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

/// The byte of one channel: x times `scale`, through the curve and sRGB, rounded to nearest. The scale of an
/// exposure is 2^stops.
std::uint8_t display_byte(float x, float scale, Tonemap tonemap);

}  // namespace gatelight::renderer
