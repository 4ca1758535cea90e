#pragma once
// LDR-FLIP of two pictures that a screen can show.

#include "renderer/metrics/flip/filters.h"
#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer::flip {

/// Both pictures have one size and linear values in [0, 1]. Errors are in [0, 1].
Plane ldr_errors(const RgbPlanes& reference, const RgbPlanes& test, const Filters& filters);

}  // namespace gatelight::renderer::flip
