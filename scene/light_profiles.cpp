#include "scene/light_profiles.h"

#include <fmt/format.h>

#include <memory>

#include "scene/light_names.h"
#include "scene/scene_error.h"

namespace gatelight::scene {

void give_profiles(Scene& scene, const std::vector<LightProfile>& profiles) {
  for (const LightProfile& wanted : profiles) {
    const auto profile = std::make_shared<const IesProfile>(read_ies_profile(wanted.file));
    bool used = false;
    for (PunctualLight& light : scene.lights) {
      if (!fits_name(wanted.name, light.name) || light.type == LightType::directional) continue;
      light.profile = profile;
      used = true;
    }
    if (!used) {
      throw SceneError(fmt::format("{}: there is no point or spot light '{}', expected {}", scene.path,
                                   wanted.name, describe_placed_lights(scene)));
    }
  }
  for (PunctualLight& light : scene.lights) {
    if (light.profile) light.type = LightType::point;
  }
}

}  // namespace gatelight::scene
