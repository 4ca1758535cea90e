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

/// In a group: the environment with its sun.
inline constexpr const char* kEnvironmentWord = "environment";
/// The group of the lights that no group names.
inline constexpr const char* kRestGroup = "rest";
inline constexpr std::size_t kMostLightGroups = 16;

/// What read_light_groups() takes.
std::string text_of(const std::vector<LightGroup>& groups);
/// Reads "NAME=LIGHT,LIGHT;NAME=LIGHT", or "none". Throws BadOption that names the flag, the part and what
/// was expected.
std::vector<LightGroup> read_light_groups(const std::string& text);
/// Throws BadOption: the flag, and why.
[[noreturn]] void refuse_light_groups(const std::string& why);
/// Refuses unless there are at most kMostLightGroups, each with lights and a name of its own.
void check_light_groups(const std::vector<LightGroup>& groups);

}  // namespace gatelight::renderer
