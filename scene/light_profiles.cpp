#include "scene/light_profiles.h"

#include <fmt/format.h>

#include <memory>

#include "base/errors.h"
#include "scene/light_names.h"

namespace gatelight::scene {
namespace {

/// The reason why no light got the profile.
std::string no_such_light(const Scene& scene, const std::string& wanted) {
  LightNames names(scene);
  names.materials.clear();
  for (const PunctualLight& light : scene.lights) {
    if (light.type != LightType::directional) continue;
    if (fits_light_name(wanted, light.name))
      return fmt::format("the light '{}' is directional, expected a point or spot light", light.name);
    names.lights.erase(light.name);
  }
  return sentence(names.no_such_light(wanted));
}

}  // namespace

void give_profiles(Scene& scene, const std::vector<LightProfile>& profiles) {
  for (const LightProfile& wanted : profiles) {
    const auto profile = std::make_shared<const IesProfile>(read_ies_profile(wanted.file));
    bool used = false;
    for (PunctualLight& light : scene.lights) {
      if (!fits_light_name(wanted.name, light.name) || light.type == LightType::directional) continue;
      light.profile = profile;
      used = true;
    }
    if (!used) throw InputError(fmt::format("{}: {}", scene.path, no_such_light(scene, wanted.name)));
  }
  for (PunctualLight& light : scene.lights) {
    if (light.profile) light.type = LightType::point;
  }
}

}  // namespace gatelight::scene
