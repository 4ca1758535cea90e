#include "scene/light_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

namespace gatelight::scene {
namespace {

/// "lights 'a', 'b'"; at most so many names that they fit into a line.
std::string list_names(const char* what, const std::set<std::string>& names) {
  constexpr std::size_t kMost = 24;
  std::vector<std::string> quoted;
  for (const std::string& name : names) {
    if (quoted.size() < kMost) quoted.push_back(fmt::format("'{}'", name));
  }
  if (names.size() > kMost) quoted.push_back(fmt::format("and {} more", names.size() - kMost));
  return fmt::format("{} {}", what, fmt::join(quoted, ", "));
}

}  // namespace

bool fits_name(const std::string& wanted, const std::string& name) {
  if (wanted.empty() || wanted.back() != '*') return wanted == name;
  return name.compare(0, wanted.size() - 1, wanted, 0, wanted.size() - 1) == 0;
}

std::string describe_light_names(const Scene& scene) {
  std::set<std::string> lights, materials;
  for (const PunctualLight& light : scene.lights) lights.insert(light.name);
  for (const Material& material : scene.materials) {
    if (material.emits()) materials.insert(material.name);
  }
  if (lights.empty() && materials.empty()) return "none: the file has no light and no emissive material";
  std::vector<std::string> parts;
  if (!lights.empty()) parts.push_back(list_names("one of its lights", lights));
  if (!materials.empty()) parts.push_back(list_names("one of its emissive materials", materials));
  return fmt::format("{}", fmt::join(parts, ", or "));
}

std::string describe_placed_lights(const Scene& scene) {
  std::set<std::string> names;
  for (const PunctualLight& light : scene.lights) {
    if (light.type != LightType::directional) names.insert(light.name);
  }
  return names.empty() ? "none: the file has no such light" : list_names("one of", names);
}

}  // namespace gatelight::scene
