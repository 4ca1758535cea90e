#pragma once
// One call of `gatelight render`: loads the scene, makes its pictures, writes and reports them.

#include <string>
#include <vector>

#include "apps/render/run_team.h"
#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Returns the exit code.
int render(RenderSettings settings, const std::vector<std::string>& command, RunTeam& team);

}  // namespace gatelight::apps
