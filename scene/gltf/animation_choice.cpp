#include "scene/gltf/animation_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string>

#include "base/nearest_word.h"
#include "base/to_number.h"
#include "scene/gltf/channels.h"
#include "scene/gltf/unchecked.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// The last key of an animation, as glTF wants it in the `max` of the times; 0 where that is missing.
double stated_seconds(const json& root, const json& animation) {
  const json& accessors = list_of(root, "accessors");
  double seconds = 0.0;
  for (const json& sampler : list_of(animation, "samplers")) {
    const std::optional<std::size_t> times = index_of(sampler, "input", accessors.size());
    if (!times) continue;
    const json& most = list_of(accessors[*times], "max");
    if (!most.empty() && most[0].is_number()) seconds = std::max(seconds, most[0].get<double>());
  }
  return seconds;
}

std::size_t find_animation(const json& root, const std::string& name, std::string_view file) {
  std::vector<std::string> names;
  for (const json& animation : list_of(root, "animations")) names.push_back(text_of(animation, "name"));
  if (const auto found = std::find(names.begin(), names.end(), name); found != names.end())
    return static_cast<std::size_t>(found - names.begin());
  if (const auto index = to_number<std::size_t>(name); index && *index < names.size()) return *index;

  std::string known;
  for (std::size_t i = 0; i < names.size(); ++i)
    known += fmt::format("{}{} ({})", i == 0 ? "" : ", ", i, names[i]);
  throw make_error(file, "animations",
                   fmt::format("there is no animation '{}', expected {}{}", name,
                               names.empty() ? "none: the file has no animations" : "one of: " + known,
                               did_you_mean(name, names)));
}

/// All animations, without those of a value that an earlier one animates.
std::vector<std::size_t> without_rivals(const json& animations, Warnings& warnings) {
  std::vector<std::size_t> chosen;
  std::vector<std::string> rivals;
  std::set<std::string> animated;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    std::set<std::string> own;
    for (const json& channel : list_of(animations[i], "channels")) own.insert(pointer_of(channel));
    own.erase("");
    if (std::any_of(own.begin(), own.end(), [&](const std::string& p) { return animated.contains(p); })) {
      rivals.push_back(fmt::format("{} ({})", i, text_of(animations[i], "name")));
    } else {
      animated.merge(own);
      chosen.push_back(i);
    }
  }
  if (!rivals.empty()) {
    warnings.add(fmt::format(
        "animations of values that an earlier animation changes are ignored: {}; `animation` chooses one",
        fmt::join(rivals, ", ")));
  }
  return chosen;
}

}  // namespace

std::vector<Animation> list_animations(const json& root) {
  std::vector<Animation> animations;
  for (const json& animation : list_of(root, "animations"))
    animations.push_back({text_of(animation, "name"), stated_seconds(root, animation)});
  return animations;
}

std::vector<std::size_t> choose_animations(const json& root, const LoadOptions& options,
                                           std::string_view file, Warnings& warnings) {
  std::vector<std::size_t> chosen;
  if (options.animation == kNoAnimation) return chosen;
  if (!options.animation.empty()) chosen.push_back(find_animation(root, options.animation, file));
  if (!options.time) return {};
  const json& animations = list_of(root, "animations");
  return chosen.empty() ? without_rivals(animations, warnings) : chosen;
}

}  // namespace gatelight::scene::gltf
