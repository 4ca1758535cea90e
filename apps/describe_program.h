#pragma once
// The command line as data, for manual pages and completion.

#include <vector>

#include "apps/manual/program_text.h"
#include "apps/subcommand.h"

namespace gatelight::apps {

ProgramText describe_program(const CLI::App& root, const std::vector<Subcommand>& subcommands);

}  // namespace gatelight::apps
