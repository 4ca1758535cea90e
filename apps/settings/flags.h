#pragma once
// Options into flags of the command line. CLI11 takes seconds to compile: it is included by the sources of
// this and of what stands around all subcommands, by no other.

#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "renderer/settings/option.h"

namespace CLI {
class App;
}

namespace gatelight::apps {

/// A subcommand without flags. The footer ends its help.
CLI::App* add_subcommand(CLI::App& root, const char* name, const char* description, const char* footer);

/// What the options are bound to must outlive the parsing.
void add_flags(CLI::App& app, const std::vector<renderer::Option>& options);

/// After parsing: the flags on the command line or in --config, with their dashes.
std::vector<std::string> given_flags(const CLI::App& app);

/// After parsing: applies the preset, and reads over it all flags that were given, wherever they stood.
void finish_flags(CLI::App& app, RenderSettings& settings);

/// What `gatelight render SCENE WORDS` asks for, presets applied; complete_settings() comes after it. Outputs
/// may be missing. Throws UsageError.
RenderSettings read_render_words(const std::string& scene, const std::vector<std::string>& words);

}  // namespace gatelight::apps
