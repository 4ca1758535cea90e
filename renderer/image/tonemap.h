#pragma once
// From linear light to what a screen shows.

#include <cstdint>

#include "scene/math.h"

namespace gatelight::renderer {

enum class Tonemap : std::uint8_t {
  none,    ///< values above 1 are cut
  filmic,  ///< a smooth shoulder and toe
};

/// K. Narkowicz's fit of the ACES reference curve (2016): x(2.51x + 0.03) / (x(2.43x + 0.59) + 0.14), clamped
/// to [0, 1]. Linear in, linear out, each channel by itself.
float filmic(float x);

/// Byte of one channel: exposure in stops, curve, sRGB, rounded to nearest.
std::uint8_t display_byte(float x, float exposure_scale, Tonemap tonemap);

/// 2^stops: what display_byte() wants.
float exposure_scale(float stops);

}  // namespace gatelight::renderer
