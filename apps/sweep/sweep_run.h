#pragma once
// A call of `gatelight sweep`, from the plan to the files.

#include <string>
#include <vector>

#include "apps/sweep/request.h"

namespace gatelight::apps {

/// Returns the exit code, or throws what errors.h handles. command: the program's arguments.
int run_sweep(const SweepSettings& settings, const std::vector<std::string>& command);

}  // namespace gatelight::apps
