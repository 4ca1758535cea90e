#pragma once
// A subcommand: its flags and its function. Each has a file of its own.

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "apps/render/run_team.h"
#include "apps/settings/option.h"

namespace CLI {
class App;
}

namespace gatelight::apps {

struct Subcommand {
  CLI::App* app = nullptr;         ///< owned by the root
  std::function<int()> run;        ///< called after parsing; returns the exit code, or throws
  std::set<std::string> common{};  ///< flags of the short help, without their dashes; empty: all
};

Subcommand add_render_command(CLI::App& root, const std::vector<std::string>& command, RunTeam& team);
Subcommand add_compare_command(CLI::App& root);
Subcommand add_info_command(CLI::App& root);
Subcommand add_merge_command(CLI::App& root);
Subcommand add_denoise_command(CLI::App& root);
Subcommand add_view_command(CLI::App& root);
Subcommand add_sweep_command(CLI::App& root, const std::vector<std::string>& command);
Subcommand add_completion_command(CLI::App& root);

/// The words that may take the place of the last one, a line each; none where that is a name of a file, or of
/// the user's. `words`: those after the program's name.
std::string completions(const CLI::App& root, const std::vector<std::string>& words);

}  // namespace gatelight::apps
