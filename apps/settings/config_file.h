#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <set>
#include <string>

namespace gatelight::apps {

/// The values that a configuration file has set.
struct ConfigFile {
  std::string name;  ///< empty: no file was opened
  std::set<std::string>
      flags;  ///< with their dashes, "--spp" or "-o", where the command line does not set them
};

/// Reads `--config FILE.toml` for the subcommand that was called: keys need no section. Lists become one word
/// with commas ("eye = [1, 2, 3]"), except for flags that may be given several times. The result is filled in
/// while `root` parses.
std::shared_ptr<const ConfigFile> accept_config_file(CLI::App& root);

/// Appends " ('FILE' sets --FLAG)" to the message for the first flag in it that the file has set.
std::string with_config_file(const std::string& message, const ConfigFile& config);

}  // namespace gatelight::apps
