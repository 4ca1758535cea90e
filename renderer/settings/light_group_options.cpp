#include "renderer/settings/light_group_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "base/errors.h"

namespace gatelight::renderer {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

constexpr const char* kOption = "light-groups";

}  // namespace

std::string text_of(const std::vector<LightGroup>& groups) {
  std::string text;
  for (const LightGroup& group : groups)
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", group.name, fmt::join(group.lights, ","));
  return text;
}

void check_light_groups(const std::vector<LightGroup>& groups) {
  std::set<std::string> names;
  for (const LightGroup& group : groups) {
    const auto refuse = [&group](const char* problem, const char* expected) {
      throw BadOption({kOption, text_of({group}), problem, expected});
    };
    if (group.name.empty() || !std::all_of(group.name.begin(), group.name.end(), is_letter))
      refuse("has no such name", "one of letters, digits, '-' and '_'");
    if (group.name == kRestGroup)
      refuse("has the name that is reserved for all other lights", "another name");
    if (!names.insert(group.name).second) refuse("is given twice", "it once");
    if (group.lights.empty() || std::any_of(group.lights.begin(), group.lights.end(),
                                            [](const std::string& light) { return light.empty(); }))
      refuse("lacks a light", "NAME=LIGHT,LIGHT");
  }
  if (groups.size() > kMaxLightGroups)
    throw BadOption({kOption, "", fmt::format("there are {} groups", groups.size()),
                     fmt::format("at most {}", kMaxLightGroups)});
}

}  // namespace gatelight::renderer
