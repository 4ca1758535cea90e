#include "scene/light_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "base/nearest_word.h"

namespace gatelight::scene {

std::string list_names(const char* what, const std::set<std::string>& names) {
  constexpr std::size_t kMax = 24;
  std::vector<std::string> quoted;
  for (const std::string& name : names) {
    if (quoted.size() < kMax) quoted.push_back(fmt::format("'{}'", name));
  }
  if (names.size() > kMax) quoted.push_back(fmt::format("and {} more", names.size() - kMax));
  return fmt::format("{} {}", what, fmt::join(quoted, ", "));
}

bool fits_light_name(const std::string& wanted, const std::string& name) {
  if (wanted.empty() || wanted.back() != '*') return wanted == name;
  return name.compare(0, wanted.size() - 1, wanted, 0, wanted.size() - 1) == 0;
}

bool may_emit(const Scene& scene, const Material& material) {
  const auto& dark = scene.dark_lights;
  return material.emits() || !scene.animations.empty() ||
         std::find(dark.begin(), dark.end(), material.name) != dark.end();
}

LightNames::LightNames(const Scene& scene) : materials(scene.dark_lights.begin(), scene.dark_lights.end()) {
  for (const PunctualLight& light : scene.lights) lights.insert(light.name);
  for (const Material& material : scene.materials) {
    if (material.emits()) materials.insert(material.name);
  }
}

ErrorParts LightNames::no_such_light(const std::string& wanted, const std::string& word) const {
  std::vector<std::string> parts, all(lights.begin(), lights.end());
  all.insert(all.end(), materials.begin(), materials.end());
  if (!lights.empty()) parts.push_back(list_names("one of its lights", lights));
  if (!materials.empty()) parts.push_back(list_names("one of its emissive materials", materials));
  if (!word.empty()) {
    parts.push_back(fmt::format("'{}'", word));
    all.push_back(word);
  }
  if (parts.empty()) parts = {"none: the file has no light and no emissive material"};
  return {.problem = fmt::format("there is no light '{}'", wanted),
          .expected = fmt::format("{}", fmt::join(parts, ", or ")),
          .hint = did_you_mean(wanted, all)};
}

}  // namespace gatelight::scene
