#include "apps/settings/flags.h"

#include <CLI/CLI.hpp>

#include "apps/settings/option_table.h"
#include "apps/terminal/errors.h"

namespace gatelight::apps {
namespace {

CLI::Option* bind(CLI::App& app, const Option& option) {
  std::string name = option.positional ? option.name : option.flag();
  if (!option.letter.empty()) name = option.letter + "," + name;
  if (option.toggle) return app.add_flag(name, *option.toggle, option.help);
  if (!option.list) return app.add_option_function<std::string>(name, option.read, option.help);
  CLI::Option* list = app.add_option(name, *option.list, option.help);
  if (!option.positional) list->expected(option.words);
  if (!option.positional && option.words == 1) list->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return list;
}

void add_flag(CLI::App& app, const Option& option) {
  CLI::Option* flag = bind(app, option);
  flag->group(option.group)->required(option.required);
  if (option.toggle) return;
  flag->type_name(option.unit);
  if (const std::string text = option.shown_default(); !text.empty()) flag->default_str(text);
}

}  // namespace

CLI::App* add_subcommand(CLI::App& root, const char* name, const char* description, const char* footer) {
  CLI::App* app = root.add_subcommand(name, description);
  app->footer(footer);
  return app;
}

void add_flags(CLI::App& app, const std::vector<Option>& options) {
  for (const Option& option : options) {
    add_flag(app, option);
  }
}

std::string name_of(const CLI::Option& option) {
  // The library gives no name for flags that are not in the help.
  return option.get_lnames().empty() ? option.get_name() : option.get_lnames().front();
}

std::vector<std::string> given_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() > 0) names.push_back(name_of(*option));
  }
  return names;
}

void finish_flags(CLI::App& app, RenderSettings& settings) {
  if (settings.preset) {
    const auto apply = settings.frames.any() ? renderer::apply_preset_of_frames : renderer::apply_preset;
    apply(*settings.preset, settings.render);
    // They were read once already, before the preset.
    for (CLI::Option* option : app.get_options()) {
      if (option->count() > 0) option->run_callback();
    }
  }
  const std::vector<std::string> given = given_names(app);
  settings.given.insert(given.begin(), given.end());
  const CLI::Option* config = app.get_parent() ? app.get_parent()->get_config_ptr() : nullptr;
  if (config != nullptr && config->count() > 0) settings.config = config->as<std::string>();
}

RenderSettings parse_render_arguments(const std::string& scene, const std::vector<std::string>& words) {
  CLI::App app;
  RenderSettings settings;
  add_flags(app, option_table(settings));
  app.get_option("--output")->required(false);
  // CLI11 expects the arguments in reverse order.
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  reversed.push_back(scene);
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    throw BadOption(error.what());
  }
  finish_flags(app, settings);
  return settings;
}

}  // namespace gatelight::apps
