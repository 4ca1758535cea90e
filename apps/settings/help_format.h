#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <set>
#include <string>

namespace gatelight::apps {

/// Formats the help of each flag, wrapped to the terminal, with the default at its end.
std::shared_ptr<CLI::Formatter> make_help_formatter();

/// The help of a subcommand: its common flags (all where the set is empty), or those of a topic. A topic is a
/// word of a group's name, and it stands where the scene would: `render --help cache`. Hides the other flags
/// of `app`.
std::string help_text(CLI::App& app, const std::string& program, const std::set<std::string>& common);

}  // namespace gatelight::apps
