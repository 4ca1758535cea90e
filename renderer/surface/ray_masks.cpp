#include "renderer/surface/ray_masks.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"

namespace gatelight::renderer {
namespace {

constexpr std::uint32_t kFirstBlockers = 6;  // bit
static_assert((1u << (kFirstBlockers + scene::kMaxBlockerSets)) == kCatcherMask);

bool is_uniform(scene::RayKinds rays, scene::RayKinds of) {
  return (rays & of) == 0 || (rays & of) == of;
}

/// Calls use(link) for each light of the scene.
template <class Use>
void each_link(const scene::Scene& scene, const Use& use) {
  for (const scene::Instance& instance : scene.instances) use(instance.link);
  for (const scene::PunctualLight& light : scene.lights) use(light.link);
  use(scene.environment_link);
}

}  // namespace

bool sees_by_lobe(const scene::Scene& scene) {
  const auto mixed = [](scene::RayKinds rays) { return !is_uniform(rays, scene::kBounceRays); };
  return mixed(scene.environment_rays) ||
         std::any_of(scene.instances.begin(), scene.instances.end(),
                     [&](const scene::Instance& i) { return mixed(i.visibility.rays); }) ||
         std::any_of(scene.lights.begin(), scene.lights.end(),
                     [&](const scene::PunctualLight& light) { return mixed(light.rays); });
}

RayMasks::RayMasks(const scene::Scene& scene, const std::vector<std::uint8_t>& catchers)
    : by_lobe_(sees_by_lobe(scene)) {
  blockers_.assign(scene.object_sets.size(), 0);
  std::uint32_t next = kFirstBlockers;
  each_link(scene, [&](const scene::LightLink& link) {
    if (link.blockers < 0) return;
    std::uint32_t& mask = blockers_[static_cast<std::size_t>(link.blockers)];
    if (mask != 0) return;
    if (next == kFirstBlockers + scene::kMaxBlockerSets)
      throw InputError(fmt::format("{}: lights have over {} different sets of blockers, expected at most {}",
                                   scene.path, scene::kMaxBlockerSets, scene::kMaxBlockerSets));
    mask = 1u << next++;
  });
  any_blockers_ = next > kFirstBlockers;
  bool alike = !any_blockers_ && catchers.empty();
  for (const scene::Instance& instance : scene.instances) {
    const scene::RayKinds rays = instance.visibility.rays;
    alike = alike && rays == scene::kAllRays;
    shadows_differ_ |= !is_uniform(rays, scene::kBounceRays | scene::kShadowRays);
  }
  if (alike) return;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::RayKinds rays = scene.instances[i].visibility.rays;
    if (rays == scene::kAllRays && !any_blockers_ && catchers.empty()) {
      masks_.push_back(~0u);  // as where all are alike, so that a BVH stays good
      continue;
    }
    std::uint32_t mask = ray_mask(rays);
    if (rays & scene::kShadowRays) {
      for (std::size_t set = 0; set < blockers_.size(); ++set) {
        if (blockers_[set] != 0 && scene.object_sets[set].instances[i] != 0) mask |= blockers_[set];
      }
    }
    if (!catchers.empty() && catchers[i] != 0) mask |= kCatcherMask;
    masks_.push_back(mask);
  }
}

}  // namespace gatelight::renderer
