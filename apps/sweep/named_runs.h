#pragma once
// Named runs: single pictures with flags of their own, by --run and --plan.

#include <string>
#include <vector>

#include "apps/sweep/flag_values.h"

namespace gatelight::apps {

struct NamedRun {
  std::string name;
  FlagValues flags;
};

/// Parses "NAME: --flag value --flag=value". Which flags there are is not checked here. Throws BadOption.
NamedRun parse_run(const std::string& text);

/// The lines of a file, each a run. Empty lines and those that begin with # are left out. Throws InputError
/// where it cannot be read, and BadOption.
std::vector<NamedRun> read_runs(const std::string& file);

}  // namespace gatelight::apps
