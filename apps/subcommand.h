#pragma once
// A part of the command line: its flags and what runs when it was called. One file for each.

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gatelight::apps {

struct Subcommand {
  CLI::App* app = nullptr;   ///< owned by the root
  std::function<int()> run;  ///< after parsing; answers the exit code, or throws
};

Subcommand add_render_command(CLI::App& root, const std::vector<std::string>& command);
Subcommand add_compare_command(CLI::App& root);
Subcommand add_info_command(CLI::App& root);
Subcommand add_merge_command(CLI::App& root);
Subcommand add_sweep_command(CLI::App& root, const std::vector<std::string>& command);

}  // namespace gatelight::apps
