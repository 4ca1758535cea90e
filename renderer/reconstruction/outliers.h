#pragma once
// Bright samples that stand alone.

#include "renderer/reconstruction/dealt_layout.h"

namespace gatelight::renderer {

/// The samples of one half, channel by channel.
struct HalfPlanes {
  Plane color[3];     ///< over what the colours are divided by
  Plane variance[3];  ///< of these
};

/// So many rows and columns around it decide what becomes of a pixel.
inline constexpr int kOutlierReach = 29;

/// A value that is far above its neighbourhood, and that the other half does not know, is noise, and a fit
/// would make a blob of it. What it has too much goes to the pixels around it in proportion to their own
/// light, so the sum of light stays; where that would be seen, the rest is lost. `divisor`: what the colours
/// were divided by. Returns what each pixel gave less what it got, times the divisor, summed over channels
/// and halves: its sum is the light that is lost. Runs in the caller's arena.
Plane spread_outliers(HalfPlanes& a, HalfPlanes& b, const Plane (&divisor)[3], int width, int height);

}  // namespace gatelight::renderer
