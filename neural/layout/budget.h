#pragma once

#include <cstdint>
#include <string>

#include "neural/layout/plan.h"

namespace gatelight::neural {

/// Returns the plan of the given options or, with a memory budget, the finest plan that fits. Throws
/// BadConfiguration for more than 2^32-1 nodes and for a budget that cannot be met.
LayoutPlan solve_plan(PlanScene& scene);

/// The shortest number of MiB that is these bytes after rounding up to whole ones: as the user wrote it.
std::string mebibytes_text(std::uint64_t bytes);

}  // namespace gatelight::neural
