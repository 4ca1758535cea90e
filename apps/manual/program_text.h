#pragma once
// The command line as data, from which manual pages and completion are made.

#include <string>
#include <vector>

#include "apps/settings/option.h"

namespace gatelight::apps {

struct CommandText {
  std::string name;             ///< "render"
  std::string summary;          ///< "Render a scene to EXR and PNG"
  std::string footer;           ///< of its help: paragraphs, then "Examples:" and lines
  std::vector<Option> options;  ///< those without a group are not in the help
};

struct ProgramText {
  CommandText program;  ///< its options belong to all subcommands
  std::vector<CommandText> commands;
  std::string version;
};

}  // namespace gatelight::apps
