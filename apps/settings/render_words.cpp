#include "apps/settings/render_words.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/settings/cache_flags.h"
#include "apps/settings/render_flags.h"
#include "apps/terminal/errors.h"

namespace gatelight::apps {

std::vector<RenderFlag> render_flags() {
  CLI::App app;
  RenderSettings settings;
  add_render_flags(app, settings);
  std::vector<RenderFlag> flags;
  for (const CLI::Option* option : app.get_options()) {
    if (option == app.get_help_ptr() || option->get_positional()) continue;
    flags.push_back({option->get_name(), option->get_expected_min() > 0});
  }
  return flags;
}

RenderSettings read_render_words(const std::string& scene, const std::vector<std::string>& words) {
  CLI::App app;
  RenderSettings settings;
  add_render_flags(app, settings);
  app.get_option("--output")->required(false);
  // The library wants the last word first.
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  reversed.push_back(scene);
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  finish_flags(app, settings);
  return settings;
}

}  // namespace gatelight::apps
