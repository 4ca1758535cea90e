#pragma once
// Linear sRGB into the two opponent spaces of FLIP and back, a row of pixels at a time. CIE XYZ stands
// relative to the white point (D65), so that white is (1, 1, 1) and no illuminant is left in the formulas.

#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer::flip {

/// Achromatic, red-green, blue-yellow: linear in light (YCxCz), or perceptually even (L*a*b*).
struct OpponentRow {
  Row y, red_green, blue_yellow;
};

struct RgbRow {
  Row r, g, b;
};

OpponentRow rgb_to_ycxcz(const RgbRow& rgb);

/// Cut to the colours of the screen.
RgbRow ycxcz_to_unit_rgb(const OpponentRow& ycxcz);

/// L*a*b*, a* and b* scaled by the Hunt effect: chroma counts more where it is bright (2020, eq. 4).
OpponentRow rgb_to_hunt_lab(const RgbRow& rgb);

/// HyAB: city-block in lightness, Euclidean in chroma.
Row hyab_distance(const OpponentRow& a, const OpponentRow& b);

}  // namespace gatelight::renderer::flip
