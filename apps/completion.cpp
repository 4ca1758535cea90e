#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>

#include "apps/settings/flags.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/terminal.h"
#include "gatelight_completion.inc"

namespace gatelight::apps {
namespace {

constexpr const char* kCompletionFooter =
    R"(The Tab key then completes subcommands, flags, their values and files. An installed program includes the scripts. They
query the program, so they work with each version.

Examples:
  echo 'source <(gatelight completion bash)' >> ~/.bashrc
  echo 'source <(gatelight completion zsh)' >> ~/.zshrc      # after compinit
  gatelight completion fish > ~/.config/fish/completions/gatelight.fish)";

constexpr std::array<Choice<const char*>, 3> kShells = {
    {{"bash", kBashScript}, {"zsh", kZshScript}, {"fish", kFishScript}}};

/// "auto" and "none" of "auto|none|FILE".
std::vector<std::string> values_of(const std::string& unit) {
  std::vector<std::string> values;
  if (unit.find('|') == std::string::npos) return values;
  for (const std::string& part : split(unit, '|')) {
    const std::string value = part.substr(0, part.find_first_of("[:"));
    if (value != "-" && value.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos)
      values.push_back(value);
  }
  return values;
}

}  // namespace

std::string completions(const CLI::App& root, const std::vector<std::string>& words) {
  const CLI::App* called = nullptr;
  const std::vector<const CLI::App*> subcommands = root.get_subcommands({});
  for (std::size_t i = 0; i + 1 < words.size() && called == nullptr; ++i) {
    const auto named = [&](const CLI::App* app) { return app->get_name() == words[i]; };
    const auto at = std::find_if(subcommands.begin(), subcommands.end(), named);
    if (at != subcommands.end()) called = *at;
  }
  std::vector<const CLI::Option*> options = root.get_options();
  if (called != nullptr) {
    const std::vector<const CLI::Option*> own = called->get_options();
    options.insert(options.end(), own.begin(), own.end());
  }
  std::vector<std::string> found;
  if (!words.empty() && words.back().starts_with('-')) {
    for (const CLI::Option* option : options) {
      for (const std::string& name : option->get_lnames()) found.push_back("--" + name);
    }
  } else if (called == nullptr) {
    for (const CLI::App* app : subcommands) found.push_back(app->get_name());
  } else {
    const auto flag = std::find_if(options.begin(), options.end(), [&](const CLI::Option* option) {
      return option->check_name(words[words.size() - 2]);
    });
    if (flag != options.end()) found = values_of((*flag)->get_type_name());
  }
  return fmt::format("{}\n", fmt::join(found, "\n"));
}

Subcommand add_completion_command(CLI::App& root) {
  CLI::App* app =
      add_subcommand(root, "completion", "Print a script for the Tab key of a shell", kCompletionFooter);
  const auto script = std::make_shared<std::string>();
  const Option shell = {
      .name = "SHELL",
      .unit = choice_names(kShells),
      .help = "Shell that reads the script",
      .read = [script](const std::string& text) { *script = parse_choice("SHELL", text, kShells); },
      .required = true,
      .positional = true};
  add_flags(*app, {shell});
  return {.app = app, .run = [script] {
            write_text("-", *script);
            return kDone;
          }};
}

}  // namespace gatelight::apps
