#pragma once
// Converts between linear sRGB and the two opponent colour spaces of FLIP, one row of pixels at a time. CIE
// XYZ is relative to the white point (D65): white is (1, 1, 1), and no illuminant appears in the formulas.

#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer::flip {

/// Achromatic, red-green and blue-yellow values: linear in light (YCxCz) or perceptually uniform (L*a*b*).
struct OpponentRow {
  Row y, red_green, blue_yellow;
};

struct RgbRow {
  Row r, g, b;
};

OpponentRow rgb_to_ycxcz(const RgbRow& rgb);

/// Clamped to [0, 1], the colours of the screen.
RgbRow ycxcz_to_unit_rgb(const OpponentRow& ycxcz);

/// L*a*b* with a* and b* scaled for the Hunt effect: chroma counts more in bright colours (2020, eq. 4).
OpponentRow rgb_to_hunt_lab(const RgbRow& rgb);

/// The HyAB distance: city-block in lightness, Euclidean in chroma.
Row hyab_distance(const OpponentRow& a, const OpponentRow& b);

}  // namespace gatelight::renderer::flip
