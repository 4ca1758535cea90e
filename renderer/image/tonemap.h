#pragma once
// Converts linear light to the bytes that a screen shows.

#include <cstdint>

#include "base/math.h"

namespace gatelight::renderer {

/// Curves from radiance to display values. All except `none` and `filmic` desaturate bright colours as film
/// does and keep hues.
enum class Tonemap : std::uint8_t {
  none,     ///< values above 1 are clamped
  filmic,   ///< K. Narkowicz's fit of the ACES curve, for each channel separately (2016)
  neutral,  ///< Khronos PBR Neutral (2024): colours below 0.8 only lose 0.04 of glare
  aces,     ///< S. Hill's fit of the ACES reference and output transforms (2017), in ACES' working space
  agx,      ///< B. Wrensch's fit of T. Sobotka's AgX, its base look (2023)
};

/// x(2.51x + 0.03) / (x(2.43x + 0.59) + 0.14), clamped to [0, 1]. Input and output are linear.
float filmic(float x);

/// Applies the curve. The result is linear Rec. 709 in [0, 1]. NaN and negative values count as 0.
Color tonemapped(const Color& color, Tonemap tonemap);

/// White balance of daylight (CIE D65), the white of sRGB.
inline constexpr float kDaylightKelvin = 6504.0f;

/// Applies the curve and sRGB: display values in [0, 1].
Color display_color(const Color& color, Tonemap tonemap);
/// The display value of a grey times `exposure_scale`, as a byte, rounded to nearest.
std::uint8_t display_byte(float x, float exposure_scale, Tonemap tonemap);

/// 2^stops.
float exposure_scale(float stops);

}  // namespace gatelight::renderer
