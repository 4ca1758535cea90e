#include "scene/light_adjustments.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "scene/light_names.h"

namespace gatelight::scene {

void adjust_lights(Scene& scene, const std::vector<LightAdjustment>& adjustments) {
  if (adjustments.empty()) return;
  const LightNames names(scene);
  std::vector<bool> used(adjustments.size(), false);
  /// The last adjustment of this name.
  const auto note_used = [&](const std::string& name) {
    const LightAdjustment* last = nullptr;
    for (std::size_t i = 0; i < adjustments.size(); ++i) {
      if (!fits_light_name(adjustments[i].name, name)) continue;
      used[i] = true;
      last = &adjustments[i];
    }
    return last;
  };
  const auto adjust = [&](const std::string& name, Color& light) {
    const LightAdjustment* const last = note_used(name);
    if (last == nullptr) return;
    light *= last->factor;
    if (!light.isFinite().all()) {
      throw InputError(fmt::format("{}: '{}' times {},{},{} is not finite, expected a smaller number",
                                   scene.path, name, last->factor.x(), last->factor.y(), last->factor.z()));
    }
  };
  for (PunctualLight& light : scene.lights) adjust(light.name, light.intensity);
  for (Material& material : scene.materials) {
    if (!material.emits()) {
      // At another time it may glow.
      if (!scene.animations.empty()) note_used(material.name);
      continue;
    }
    adjust(material.name, material.emission);
    if (!material.emits()) scene.dark_lights.push_back(material.name);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i])
      throw InputError(fmt::format("{}: {}", scene.path, sentence(names.no_such_light(adjustments[i].name))));
  }
}

}  // namespace gatelight::scene
