#pragma once
// Integrals over the directions of the sphere.

#include <cmath>

#include "base/math.h"

namespace gatelight::testing {

/// Calls use(direction, solid angle) for the middles of cells of equal steps in both angles about +y.
template <class Use>
void each_direction(int rows, const Use& use) {
  const double step = M_PI / rows;
  for (int y = 0; y < rows; ++y) {
    const double theta = (y + 0.5) * step;
    for (int x = 0; x < 2 * rows; ++x) {
      const double phi = (x + 0.5) * step;
      use(Vec3(static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
               static_cast<float>(std::sin(theta) * std::sin(phi))),
          std::sin(theta) * step * step);
    }
  }
}

}  // namespace gatelight::testing
