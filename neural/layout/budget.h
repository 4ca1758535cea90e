#pragma once

#include "neural/layout/plan.h"

namespace gatelight::neural {

/// Returns the plan of the given options or, with a memory budget, the finest plan that fits. Throws
/// BadConfiguration for more than 2^32-1 nodes and for a budget that cannot be met.
LayoutPlan solve_plan(PlanScene& scene);

}  // namespace gatelight::neural
