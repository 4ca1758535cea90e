#pragma once
// What runs and references cost, for the time left.

#include <vector>

#include "apps/sweep/eta.h"
#include "apps/sweep/plan.h"

namespace gatelight::apps {

SweepTask run_task(const PlannedScene& scene, const PlannedSeries& series, const std::vector<int>& points);
/// Of a view with these options; spp: of both halves together.
SweepTask reference_task(const PlannedScene& scene, const renderer::RenderOptions& cell, ReferenceKind kind,
                         int spp);
/// All of a scene's, before it is known which are done.
std::vector<SweepTask> all_tasks(const PlannedScene& scene, const SweepPlan& plan, int reference_spp);

}  // namespace gatelight::apps
