#include "apps/view/live_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "apps/settings/complete_settings.h"
#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

/// The options that a window changes, with those that they replace.
const std::map<std::string, std::vector<std::string>>& live_options() {
  static const std::map<std::string, std::vector<std::string>> options = [] {
    std::map<std::string, std::vector<std::string>> live;
    RenderSettings settings;
    for (const Option& option : option_table(settings)) {
      if (option.marks.in_window || option.marks.of_view) live[option.name] = option.marks.excludes;
    }
    return live;
  }();
  return options;
}

std::vector<std::string> words_of(const std::vector<std::string>& words, const LiveFlags& flags) {
  std::set<std::string> replaced;
  for (const auto& [name, value] : flags) {
    replaced.insert(name);
    replaced.insert(live_options().at(name).begin(), live_options().at(name).end());
  }
  std::vector<std::string> all;
  std::copy_if(words.begin(), words.end(), std::back_inserter(all), [&](const std::string& word) {
    return !replaced.contains(word.substr(2, word.find('=') - 2));
  });
  for (const auto& [name, value] : flags) all.push_back(fmt::format("--{}={}", name, value));
  return all;
}

}  // namespace

std::vector<std::string> given_words(RenderSettings settings) {
  std::vector<std::string> words;
  const std::set<std::string> given = settings.given;
  for (const Option& option : option_table(settings)) {
    if (!given.contains(option.name) || option.positional || option.name == "config") continue;
    words.push_back(option.toggle ? option.flag() : option.flag() + "=" + option.text());
  }
  return words;
}

LiveFlags changed(LiveFlags flags, const FlagChange& change) {
  for (const auto& [name, value] : change) {
    const auto option = live_options().find(name);
    if (option == live_options().end())
      throw BadOption({one_line(name), "", "cannot be changed in the window",
                       "it on the command line of `gatelight view`"});
    if (!value) {
      flags.erase(name);
      continue;
    }
    flags[name] = *value;
    for (const std::string& other : option->second) flags.erase(other);
  }
  return flags;
}

RenderSettings settings_of(const std::string& scene, const std::vector<std::string>& words,
                           const LiveFlags& flags) {
  RenderSettings settings = parse_render_arguments(scene, words_of(words, flags));
  apply_display_defaults(settings);
  complete_settings(settings);
  return settings;
}

std::string render_command(const std::string& scene, const std::vector<std::string>& words,
                           const LiveFlags& flags) {
  std::vector<std::string> command = {"gatelight", "render", scene};
  const std::vector<std::string> all = words_of(words, flags);
  command.insert(command.end(), all.begin(), all.end());
  return quote_command(command);
}

}  // namespace gatelight::apps
