#pragma once

#include "neural/layout/gate_layout.h"

namespace gatelight::neural {

/// Throw BadConfiguration, naming what is wrong and what was expected.
void check_gate_options(const GateOptions& options);
/// Every position of every mesh, and the transforms of instances with storage, must be finite.
void check_surfaces(const SurfaceLayout& surfaces);

}  // namespace gatelight::neural
