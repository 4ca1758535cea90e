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

}  // namespace

std::string text_of(const std::vector<LightGroup>& groups) {
  std::string text;
  for (const LightGroup& group : groups)
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", group.name, fmt::join(group.lights, ","));
  return text;
}

void refuse_light_groups(const std::string& why) {
  throw BadOption(fmt::format("`light-groups`: {}", why));
}

void check_light_groups(const std::vector<LightGroup>& groups) {
  std::set<std::string> names;
  for (const LightGroup& group : groups) {
    if (group.name.empty() || !std::all_of(group.name.begin(), group.name.end(), is_letter))
      refuse_light_groups(fmt::format("'{}' is not a name of letters, digits, '-' and '_'", group.name));
    if (group.name == kRestGroup)
      refuse_light_groups(fmt::format(
          "'{}' is the group of the lights that no group names, expected another name", group.name));
    if (!names.insert(group.name).second)
      refuse_light_groups(fmt::format("the group '{}' is there twice, expected it once", group.name));
    if (group.lights.empty() || std::any_of(group.lights.begin(), group.lights.end(),
                                            [](const std::string& light) { return light.empty(); }))
      refuse_light_groups(
          fmt::format("'{}={}' is not NAME=LIGHT,LIGHT", group.name, fmt::join(group.lights, ",")));
  }
  if (groups.size() > kMostLightGroups)
    refuse_light_groups(fmt::format("{} groups, expected at most {}", groups.size(), kMostLightGroups));
}

}  // namespace gatelight::renderer
