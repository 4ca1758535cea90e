#pragma once

#include "apps/render/run_team.h"

namespace gatelight::apps {

/// Parses the command line and its --config file, but runs nothing. Returns 0, or the exit code of an error
/// after printing it to stderr. Throws nothing.
int read_only(int argc, const char* const* argv);

/// Runs the whole program. Returns the exit code; throws nothing.
int run(int argc, const char* const* argv);
/// Runs the program as one of a team. All of them run the same command.
int run(int argc, const char* const* argv, RunTeam& team);

}  // namespace gatelight::apps
