#include "apps/describe_program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/terminal/version.h"

namespace gatelight::apps {
namespace {

CommandText text_of(const CLI::App& app) {
  return {
      .name = app.get_name(), .summary = app.get_description(), .footer = app.get_footer(), .options = {}};
}

/// A flag that the library has made: --help and the like.
Option option_of(const CLI::Option& option) {
  Option described{
      .name = option.get_lnames().front(), .unit = option.get_type_name(), .help = option.get_description()};
  if (!option.get_snames().empty()) described.letter = fmt::format("-{}", option.get_snames().front());
  if (described.help.ends_with('.')) described.help.pop_back();
  return described;
}

}  // namespace

ProgramText describe_program(const CLI::App& root, const std::vector<Subcommand>& subcommands) {
  const std::string with_revision = version();
  ProgramText text{text_of(root), {}, with_revision.substr(0, with_revision.find(' '))};
  for (const CLI::Option* option : root.get_options()) text.program.options.push_back(option_of(*option));
  for (const Subcommand& subcommand : subcommands) {
    text.commands.push_back(text_of(*subcommand.app));
    text.commands.back().options = subcommand.options;
  }
  return text;
}

}  // namespace gatelight::apps
