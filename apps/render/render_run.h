#pragma once
// One call of `gatelight render`: loads the scene, makes its pictures, writes and reports them.

#include <string>
#include <vector>

#include "apps/ranks/rank_group.h"
#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Returns the exit code. `group`: the ranks that make pictures together, some of `all` where there are
/// --frame-groups.
int render(RenderSettings settings, const std::vector<std::string>& command, const RankGroup& group,
           const RankGroup& all);

}  // namespace gatelight::apps
