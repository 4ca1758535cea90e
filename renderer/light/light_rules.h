#pragma once
// The objects and rays that each light concerns (scene/visibility.h).

#include <cstdint>
#include <vector>

#include "renderer/light/lights.h"
#include "renderer/surface/ray.h"
#include "renderer/surface/ray_masks.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The rule of a light.
struct LightRule {
  scene::RayKinds rays = scene::kAllRays;       ///< kinds of bounces that would find it
  const scene::ObjectSet* receivers = nullptr;  ///< null: all
  std::uint32_t shadow_mask = ray_mask(scene::kShadowRays);

  /// Whether it lights this object; kNoInstance is fog.
  bool lights(std::uint32_t instance) const {
    if (receivers == nullptr) return true;
    return instance == kNoInstance ? receivers->fog : receivers->instances[instance] != 0;
  }
};

/// Holds a reference to the lights.
class LightRules {
 public:
  LightRules(const scene::Scene& scene, const Lights& lights, const RayMasks& masks);
  LightRules(const LightRules&) = delete;
  LightRules& operator=(const LightRules&) = delete;

  /// Whether all lights concern all objects and bounces. The functions that return a rule must not be called.
  bool empty() const { return of_others_.empty(); }
  /// Of an instance that emits.
  const LightRule& of_instance(std::uint32_t instance) const { return of_instance_[instance]; }
  const LightRule& of_environment() const { return of_others_.back(); }
  /// Of LightSample::light.
  const LightRule& of_light(std::uint32_t light) const {
    return light < triangles_.size() ? of_instance_[triangles_[light].instance]
                                     : of_others_[light - triangles_.size()];
  }

 private:
  const EmissiveTriangles& triangles_;
  std::vector<scene::ObjectSet> sets_;  ///< copies: a window replaces those of its scene
  std::vector<LightRule> of_instance_;
  std::vector<LightRule> of_others_;  ///< of the lights after the triangles, by their numbers
};

}  // namespace gatelight::renderer
