#include "apps/view/live_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "apps/settings/complete_settings.h"
#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/settings/show_well.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

constexpr std::array<std::string_view, 27> kLive = {"animation",
                                                    "aperture",
                                                    "background",
                                                    "blades",
                                                    "camera",
                                                    "clamp",
                                                    "environment",
                                                    "environment-rotation",
                                                    "environment-scale",
                                                    "exposure",
                                                    "eye",
                                                    "focus",
                                                    "fov",
                                                    "lens",
                                                    "lights",
                                                    "max-depth",
                                                    "projection",
                                                    "seed",
                                                    "size",
                                                    "sky",
                                                    "spp",
                                                    "target",
                                                    "time",
                                                    "tonemap",
                                                    "up",
                                                    "view-height",
                                                    "white-balance"};

/// Flags that exclude each other: a new one replaces those before.
constexpr std::array<std::array<std::string_view, 2>, 3> kInsteadOf = {
    {{"camera", "eye"}, {"camera", "target"}, {"sky", "environment"}}};

std::vector<std::string> words_of(const std::vector<std::string>& words, const LiveFlags& flags) {
  std::vector<std::string> all;
  const auto is_replaced = [&](std::string_view word) {
    word.remove_prefix(2);
    const std::string_view name = word.substr(0, word.find('='));
    if (flags.contains(std::string(name))) return true;
    return std::any_of(kInsteadOf.begin(), kInsteadOf.end(), [&](const auto& pair) {
      return (name == pair[0] && flags.contains(std::string(pair[1]))) ||
             (name == pair[1] && flags.contains(std::string(pair[0])));
    });
  };
  std::copy_if(words.begin(), words.end(), std::back_inserter(all),
               [&](const std::string& word) { return !is_replaced(word); });
  for (const auto& [name, value] : flags) all.push_back(fmt::format("--{}={}", name, value));
  return all;
}

}  // namespace

std::vector<std::string> given_words(RenderSettings settings) {
  std::vector<std::string> words;
  const std::set<std::string> given = settings.given;
  for (const Option& option : option_table(settings)) {
    if (!given.contains(option.flag()) || option.positional || option.name == "config") continue;
    words.push_back(option.toggle ? option.flag() : option.flag() + "=" + option.text());
  }
  return words;
}

LiveFlags changed(LiveFlags flags, const FlagChange& change) {
  for (const auto& [name, value] : change) {
    if (std::find(kLive.begin(), kLive.end(), name) == kLive.end())
      throw UsageError(
          fmt::format("--{}: a window does not change it, expected it on the command line of "
                      "`gatelight view`",
                      one_line(name)));
    if (!value) {
      flags.erase(name);
      continue;
    }
    flags[name] = *value;
    for (const auto& [one, other] : kInsteadOf) {
      if (name == one) flags.erase(std::string(other));
      if (name == other) flags.erase(std::string(one));
    }
  }
  return flags;
}

RenderSettings settings_of(const std::string& scene, const std::vector<std::string>& words,
                           const LiveFlags& flags) {
  RenderSettings settings = read_render_words(scene, words_of(words, flags));
  show_well(settings);
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
