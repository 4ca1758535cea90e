#pragma once

#include "neural/layout/gate_layout.h"

namespace gatelight::neural {

/// Runs in parallel (oneTBB) and gives the same layout for any number of threads. Throws BadConfiguration for
/// options out of range, indices beyond a mesh's positions, a mesh number that is not there, positions or
/// transforms that are not finite, or more than 2^32-1 nodes, words of topology or triangles with storage.
GateLayout build_gate_layout(const SurfaceLayout& surfaces, const GateOptions& options);

}  // namespace gatelight::neural
