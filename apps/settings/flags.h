#pragma once
// Makes flags of the command line from options. CLI11 takes seconds to compile: only flags.cpp and the
// sources that handle all subcommands include it.

#include <string>
#include <vector>

#include "apps/settings/option.h"
#include "apps/settings/render_settings.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace gatelight::apps {

/// Adds a subcommand without flags. The footer ends its help.
CLI::App* add_subcommand(CLI::App& root, const char* name, const char* description, const char* footer);

/// Adds flags. The members that the options are bound to must outlive the parsing.
void add_flags(CLI::App& app, const std::vector<Option>& options);

/// The name of an option in its table.
std::string name_of(const CLI::Option& option);
/// The names of the options on the command line or in --config.
std::vector<std::string> given_names(const CLI::App& app);

/// After parsing: applies the preset and then reads all given flags again, so that they override it.
void finish_flags(CLI::App& app, RenderSettings& settings);

/// The settings of `gatelight render SCENE WORDS` with presets applied. Outputs may be missing. Call
/// complete_settings() afterwards. Throws BadOption.
RenderSettings parse_render_arguments(const std::string& scene, const std::vector<std::string>& words);

}  // namespace gatelight::apps
