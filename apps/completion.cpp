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
    R"(The Tab key then completes subcommands, flags, their values and files, and after --camera the names of the scene's
cameras. An installed program brings the scripts along. They ask the program, so that they fit each version.

Examples:
  echo 'source <(gatelight completion bash)' >> ~/.bashrc
  echo 'source <(gatelight completion zsh)' >> ~/.zshrc      # after compinit
  gatelight completion fish > ~/.config/fish/completions/gatelight.fish)";

constexpr std::array<Choice<const char*>, 3> kShells = {
    {{"bash", kBashScript}, {"zsh", kZshScript}, {"fish", kFishScript}}};

}  // namespace

Subcommand add_completion_command(CLI::App& root) {
  CLI::App* app =
      add_subcommand(root, "completion", "Print a script for the Tab key of a shell", kCompletionFooter);
  const auto script = std::make_shared<std::string>();
  const std::string names = choice_names(kShells);
  const std::vector<Option> options = {
      {.name = "SHELL",
       .unit = names,
       .help = "Shell that reads the script",
       .read = [script](const std::string& text) { *script = parse_choice("SHELL", text, kShells); },
       .required = true,
       .positional = true}};
  add_flags(*app, options);
  return {.app = app,
          .run =
              [script] {
                write_text("-", *script);
                return kDone;
              },
          .options = options};
}

}  // namespace gatelight::apps
