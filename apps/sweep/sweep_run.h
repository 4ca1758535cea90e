#pragma once
// One call of `gatelight sweep`, from the plan to the files.

#include <string>
#include <vector>

#include "apps/sweep/sweep_settings.h"

namespace gatelight::apps {

/// Answers the exit code, or throws what errors.h understands. command: the program's arguments.
int run_sweep(const SweepSettings& settings, const std::vector<std::string>& command);

}  // namespace gatelight::apps
