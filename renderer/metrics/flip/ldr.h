#pragma once
// LDR-FLIP between two pictures that a screen can show.

#include "renderer/metrics/flip/filters.h"
#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer::flip {

/// Both of one size, linear, within [0, 1]. Errors in [0, 1].
Plane ldr_errors(const RgbPlanes& reference, const RgbPlanes& test, const Filters& filters);

}  // namespace gatelight::renderer::flip
