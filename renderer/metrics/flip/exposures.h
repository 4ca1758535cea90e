#pragma once
// Chooses and applies the exposures of HDR-FLIP.

#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer::flip {

struct Exposures {
  double start = 0.0;  ///< in stops
  double stop = 0.0;
  int count = 1;

  double at(int i) const { return count > 1 ? start + i * (stop - start) / (count - 1) : start; }
};

/// `reference` is radiance without negative values.
Exposures choose_exposures(const RgbPlanes& reference);

/// Display values: radiance times 0.6 * 2^stops through the ACES curve filmic().
RgbPlanes expose(const RgbPlanes& radiance, double stops);

}  // namespace gatelight::renderer::flip
