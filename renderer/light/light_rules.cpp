#include "renderer/light/light_rules.h"

namespace gatelight::renderer {

LightRules::LightRules(const scene::Scene& scene, const Lights& lights, const RayMasks& masks)
    : triangles_(lights.triangles()), sets_(scene.object_sets) {
  bool any = false;
  // Objects that the camera does not see need no rule.
  const auto rule_of = [&](scene::RayKinds rays, const scene::LightLink& link,
                           scene::RayKinds that_count = scene::kBounceRays) {
    LightRule rule{.rays = rays, .shadow_mask = masks.of_shadow(link)};
    if (link.receivers >= 0) rule.receivers = &sets_[static_cast<std::size_t>(link.receivers)];
    any |= (~rays & that_count) != 0 || link.any();
    return rule;
  };
  for (const scene::Instance& instance : scene.instances) {
    const bool emits = scene.material_of(instance).emits();
    of_instance_.push_back(emits ? rule_of(instance.visibility.rays, instance.link) : LightRule{});
  }
  for (const auto* some : {&lights.placed(), &lights.distant()}) {
    for (const scene::PunctualLight& light : *some) of_others_.push_back(rule_of(light.rays, light.link));
  }
  of_others_.push_back(
      rule_of(scene.environment_rays, scene.environment_link, scene::kCameraRays | scene::kBounceRays));
  if (any) return;
  of_instance_.clear();
  of_others_.clear();
}

}  // namespace gatelight::renderer
