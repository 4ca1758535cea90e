#pragma once
// One call of `gatelight render`, from the settings to the files.

#include <string>
#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Answers the exit code, or throws what errors.h understands. command: the program's arguments, for the
/// recipe.
int run_render(RenderSettings settings, const std::vector<std::string>& command);

}  // namespace gatelight::apps
