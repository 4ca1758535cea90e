#include "scene/light_adjustments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "scene/scene_error.h"

namespace gatelight::scene {
namespace {

bool fits(const LightAdjustment& adjustment, const std::string& name) {
  const std::string& wanted = adjustment.name;
  if (wanted.empty() || wanted.back() != '*') return wanted == name;
  return name.compare(0, wanted.size() - 1, wanted, 0, wanted.size() - 1) == 0;
}

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

std::string what_there_is(const Scene& scene) {
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

}  // namespace

void adjust_lights(Scene& scene, const std::vector<LightAdjustment>& adjustments) {
  std::vector<bool> used(adjustments.size(), false);
  const auto adjust = [&](const std::string& name, Color& light) {
    const LightAdjustment* last = nullptr;
    for (std::size_t i = 0; i < adjustments.size(); ++i) {
      if (!fits(adjustments[i], name)) continue;
      used[i] = true;
      last = &adjustments[i];
    }
    if (last == nullptr) return;
    light *= last->factor;
    if (!light.isFinite().all()) {
      throw SceneError(fmt::format("{}: '{}' times {},{},{} is not finite, expected a smaller number",
                                   scene.path, name, last->factor.x(), last->factor.y(), last->factor.z()));
    }
  };
  const std::string choice = adjustments.empty() ? "" : what_there_is(scene);
  for (PunctualLight& light : scene.lights) adjust(light.name, light.intensity);
  for (Material& material : scene.materials) {
    if (material.emits()) adjust(material.name, material.emission);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) {
      throw SceneError(
          fmt::format("{}: there is no light '{}', expected {}", scene.path, adjustments[i].name, choice));
    }
  }
}

}  // namespace gatelight::scene
