#pragma once
// Which rays meet which instances (scene/visibility.h), as Embree's masks: a ray meets the instances that
// have a bit in common with it.

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

/// The mask of rays of these kinds; shadow rays are those in the light of all lights without blockers of
/// their own.
constexpr std::uint32_t ray_mask(scene::RayKinds kinds) {
  return kinds;
}

/// Rays meet shadow catchers only.
inline constexpr std::uint32_t kCatcherMask = 1u << 31;

class RayMasks {
 public:
  /// `catchers`: 1 for instances that are shadow catchers, or empty. Throws InputError for more sets of
  /// blockers than there are bits.
  RayMasks(const scene::Scene& scene, const std::vector<std::uint8_t>& catchers);

  /// All bits in a scene where all rays see everything.
  std::uint32_t of_instance(std::uint32_t instance) const { return masks_.empty() ? ~0u : masks_[instance]; }
  bool all_alike() const { return masks_.empty(); }
  /// The mask of shadow rays to a light.
  std::uint32_t of_shadow(const scene::LightLink& light) const {
    return light.blockers < 0 ? ray_mask(scene::kShadowRays)
                              : blockers_[static_cast<std::size_t>(light.blockers)];
  }

  /// Whether rays that diffuse, glossy and transmitting lobes and media scatter meet different objects or
  /// light, so that the lobe that a path follows counts.
  bool by_lobe() const { return by_lobe_; }
  /// Whether some object is seen by shadow rays and not by bounces, or the other way round. What a surface
  /// receives is then partly what shadow rays find and partly what bounces find, by the weights of MIS.
  bool shadows_differ() const { return shadows_differ_; }
  /// Whether some lights have blockers of their own, which only shadow rays know.
  bool any_blockers() const { return any_blockers_; }

 private:
  std::vector<std::uint32_t> masks_;     ///< by instance
  std::vector<std::uint32_t> blockers_;  ///< the bits of Scene::object_sets that are sets of blockers
  bool by_lobe_ = false;
  bool shadows_differ_ = false;
  bool any_blockers_ = false;
};

/// RayMasks::by_lobe() of the scene.
bool sees_by_lobe(const scene::Scene& scene);

}  // namespace gatelight::renderer
