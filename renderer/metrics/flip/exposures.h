#pragma once
// The exposures of HDR-FLIP.

#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer::flip {

struct Exposures {
  double start = 0.0;  ///< stops
  double stop = 0.0;
  int count = 1;

  double at(int i) const { return count > 1 ? start + i * (stop - start) / (count - 1) : start; }
};

/// Radiance without negative values.
Exposures choose_exposures(const RgbPlanes& reference);

/// What a screen shows of it: the ACES curve, without the factor 0.6 that its author put before it.
RgbPlanes expose(const RgbPlanes& radiance, double stops);

}  // namespace gatelight::renderer::flip
