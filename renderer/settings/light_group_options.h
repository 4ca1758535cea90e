#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/visibility.h"

namespace gatelight::renderer {

/// Lights whose part of the picture gets a separate layer.
struct LightGroup {
  std::string name;  ///< letters, digits, '-' and '_'
  /// Names of punctual lights and emissive materials, or the word `environment`. A '*' at the end of a name
  /// matches any ending.
  std::vector<std::string> lights;

  bool operator==(const LightGroup&) const = default;
};

using scene::kEnvironmentWord;
/// The group of all lights that belong to no other group.
inline constexpr const char* kRestGroup = "rest";
/// Prefix of the names of their layers.
inline constexpr const char* kLightLayer = "light-";
inline constexpr std::size_t kMaxLightGroups = 16;

/// The groups as a text: "NAME=LIGHT,LIGHT;NAME=LIGHT".
std::string text_of(const std::vector<LightGroup>& groups);
/// Throws BadOption unless there are at most kMaxLightGroups groups, each with lights and a unique name.
void check_light_groups(const std::vector<LightGroup>& groups);

}  // namespace gatelight::renderer
