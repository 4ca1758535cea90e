#pragma once
// From the areas of triangles to the resolution of an instance.

#include <cstdint>
#include <span>
#include <vector>

#include "neural/layout/gate_layout.h"
#include "neural/layout/surface_areas.h"

namespace gatelight::neural {

/// What the rule makes of each instance's areas before it is divided by the spacing (`uniform`: a length in
/// world units) or multiplied with the scale (`paper`: a number). 0 without area, and with `fixed`. Instances
/// without storage do not count: they are not among `areas`.
std::vector<double> resolution_sizes(ResolutionRule rule, std::span<const SurfaceAreas> areas);

/// The R of an adaptive level: rounded to nearest, 1 to max_resolution.
std::uint32_t adaptive_resolution(const GateOptions& options, double size, double node_spacing,
                                  float resolution_scale);

/// R of a level of the stack where the rule's is `adaptive`.
std::uint32_t level_resolution(std::uint32_t level, std::uint32_t adaptive);

}  // namespace gatelight::neural
