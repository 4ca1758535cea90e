#pragma once

#include "neural/layout/gate_layout.h"

namespace gatelight::neural {

/// These throw BadConfiguration, which names the wrong value and what was expected.
void check_gate_options(const GateOptions& options);
/// Checks indices and options of instances. All positions, and the transforms of instances with storage, must
/// be finite.
void check_surfaces(const SurfaceLayout& surfaces);

}  // namespace gatelight::neural
