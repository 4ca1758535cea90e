#pragma once

#include <CLI/CLI.hpp>

namespace gatelight::apps {

/// Reads `--config FILE.toml` for the subcommand that was called: keys need no section. Lists become one word
/// with commas ("eye = [1, 2, 3]"), but for the outputs, each of which is a word of its own.
void accept_config_file(CLI::App& root);

}  // namespace gatelight::apps
