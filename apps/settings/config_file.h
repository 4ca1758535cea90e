#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <set>
#include <string>

namespace gatelight::apps {

/// What a configuration file has set.
struct ConfigFile {
  std::string name;  ///< empty: none was opened
  std::set<std::string>
      flags;  ///< with their dashes, "--spp" or "-o", where the command line does not set them
};

/// Reads `--config FILE.toml` for the subcommand that was called: keys need no section. Lists become one word
/// with commas ("eye = [1, 2, 3]"), but for the outputs, each of which is a word of its own. The answer is
/// filled in while `root` parses.
std::shared_ptr<const ConfigFile> accept_config_file(CLI::App& root);

/// `message` with " ('FILE' sets --FLAG)" where it names a flag that the file has set; of several the first.
std::string with_config_file(const std::string& message, const ConfigFile& config);

}  // namespace gatelight::apps
