#pragma once
// Computes the resolution of an instance from the areas of its triangles.

#include <cstdint>
#include <span>
#include <vector>

#include "neural/layout/gate_layout.h"
#include "neural/layout/surface_areas.h"

namespace gatelight::neural {

/// The size of each instance by the rule: a length in world units that is divided by the spacing (`uniform`),
/// or a number that is multiplied by the scale (`paper`). 0 without area and with `fixed`. `areas` has only
/// instances with storage.
std::vector<double> resolution_sizes(ResolutionRule rule, std::span<const SurfaceAreas> areas);

/// The rule's R of an instance, rounded to nearest, 1 to max_resolution.
std::uint32_t adaptive_resolution(const GateOptions& options, double size, double node_spacing,
                                  float resolution_scale);

/// The R of a level of the stack; `adaptive` is the rule's R.
std::uint32_t level_resolution(std::uint32_t level, std::uint32_t adaptive);

}  // namespace gatelight::neural
