#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gatelight::renderer {

/// Lights whose part of a picture is a layer of its own.
struct LightGroup {
  std::string name;  ///< letters, digits, '-' and '_'
  /// Names of punctual lights and of emissive materials, where a '*' at the end stands for any further
  /// letters, and the word `environment`.
  std::vector<std::string> lights;

  bool operator==(const LightGroup&) const = default;
};

/// The name in a group of the environment with its sun.
inline constexpr const char* kEnvironmentWord = "environment";
/// The group of the lights that no group names.
inline constexpr const char* kRestGroup = "rest";
/// Prefix of the names of their layers.
inline constexpr const char* kLightLayer = "light-";
inline constexpr std::size_t kMaxLightGroups = 16;

/// The groups as a text: "NAME=LIGHT,LIGHT;NAME=LIGHT".
std::string text_of(const std::vector<LightGroup>& groups);
/// Refuses unless there are at most kMaxLightGroups, each with lights and a name of its own.
void check_light_groups(const std::vector<LightGroup>& groups);

}  // namespace gatelight::renderer
