#pragma once

#include "neural/layout/gate_layout.h"

namespace gatelight::neural {

/// Builds the layout in parallel (oneTBB); it is the same for any number of threads. Throws BadConfiguration
/// for options out of range, invalid indices, and positions or transforms that are not finite; also for more
/// than 2^32-1 nodes, topology words or triangles with storage.
GateLayout build_gate_layout(const SurfaceLayout& surfaces, const GateOptions& options);

}  // namespace gatelight::neural
