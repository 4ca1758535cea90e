#pragma once
// The walk of a path through a medium that scatters, from where it enters to the surface where it leaves: one
// loop, because dense media scatter light hundreds of times.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "renderer/medium/phase.h"
#include "renderer/medium/scattering_medium.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/path_state.h"

namespace gatelight::renderer {

/// Scattering events after which a walk ends. Only lossless bodies that are thicker than some 300 mean free
/// paths have as many.
inline constexpr int kMaxWalk = 1 << 16;

struct MediumWalk {
  bool alive = true;  ///< the path is at a surface or has left the scene; else it has ended
  int events = 0;
  /// The change of PathState::throughput.
  Color factor{1.0f, 1.0f, 1.0f};
  float spread = 0.0f;  ///< metres: that of all directions, as CachedPaths sums it up
};

/// Random numbers of the walk's events: low-discrepancy ones for the first, whose noise is visible.
class WalkNumbers {
 public:
  WalkNumbers(const Sampler& sampler, std::uint32_t surface, std::uint32_t seed)
      : sampler_(sampler), first_(dimension::kMedium + kPerWalk * surface), state_(seed) {}

  Vec2 next_2d() {
    if (used_ < kPerWalk) return sampler_.get_2d(first_ + used_++);
    return {next(), next()};
  }
  float next() {
    state_ = hash(state_ + 0x9e3779b9u);
    return sampling::to_unit_float(state_);
  }

 private:
  static constexpr std::uint32_t kPerWalk = 16;

  const Sampler& sampler_;
  std::uint32_t first_;
  std::uint32_t used_ = 0;
  std::uint32_t state_;
};

/// Walks through the medium `path.inside`, which scatters. `ray` and `hit`: the path's ray with its nearest
/// hit; afterwards those with which it leaves. add_light(light, shadow ray, number of the light, event) is
/// called for each light sample: `light` is its radiance at the walk's beginning if nothing is in between,
/// and events are counted from 1.
template <class AddLight>
MediumWalk walk_medium(const PathContext& context, PathState& path, Ray& ray, Hit& hit, int max_depth,
                       RayCounts& counts, const AddLight& add_light) {
  const ScatteringMedium& medium = *path.inside;
  WalkNumbers numbers(path.sampler, static_cast<std::uint32_t>(path.surfaces), hash(path.seed ^ 0x3c6ef372u));
  MediumWalk walk;
  const float bright = path.throughput.maxCoeff();
  const auto scale = [&](const Color& factor) {
    path.throughput *= factor;
    walk.factor *= factor;
  };
  for (;;) {
    const Vec2 u = numbers.next_2d();
    const ChannelChoice choice(medium, path.throughput, u.x());
    const float distance = sample_distance(medium, choice, u.y());
    // An event closer to a surface than its own rounding might lie behind it, outside of the medium.
    const float reach = distance + 4e-6f * (ray.origin.cwiseAbs().maxCoeff() + distance);
    if (walk.events > 0) {
      ray.t_max = reach;
      context.world.accel.intersect(std::span<const Ray>(&ray, 1), std::span<Hit>(&hit, 1), false);
      ray.t_max = kInfinity;
      ++counts.bounce;
    }
    const bool leaves = hit && hit.t <= reach;
    const bool lost = !leaves && !(distance < kInfinity);  // a channel without extinction, and no surface
    scale(flight_weight(medium, choice, std::min(leaves ? hit.t : distance, 1e30f), !leaves && !lost));
    if (leaves || lost) return walk;
    if (path.depth >= max_depth && walk.events == 0) break;
    if (++walk.events == 1) path.depth += 1;
    if (walk.events == kMaxWalk) break;
    // Russian roulette below an eighth of the light that came in.
    const float survival = std::min(1.0f, 8.0f * path.throughput.maxCoeff() / bright);
    if (!(numbers.next() < survival)) break;
    scale(Color::Constant(1.0f / survival));

    const Vec3 position = ray.origin + distance * ray.direction;
    const float travelled = distance;
    if (medium.sampled) {
      const Vec2 u_light = numbers.next_2d();
      const LightSample light =
          context.world.lights.sample(position, Vec3::Zero(), numbers.next(), u_light, ray.time);
      if (light.pdf > 0.0f) {
        const float value = phase(medium.anisotropy, ray.direction.dot(light.wi));
        const float weight = (light.delta ? 1.0f : context.mis.light_weight(light.pdf, value)) / light.pdf;
        Ray shadow{position, light.distance, light.wi, shadow_seed(path.seed), ray.time};
        if (light.distance < kInfinity) shadow.t_max -= light.offset / light.cosine;
        shadow.inside = &medium;
        add_light(Color(walk.factor * light.radiance * (value * weight)), shadow, light.light, walk.events);
      }
    }
    const Vec3 wi = sample_phase(medium.anisotropy, ray.direction, numbers.next_2d());
    const float pdf = phase(medium.anisotropy, ray.direction.dot(wi));
    path.previous = {position, Vec3::Zero(), 0.0f, pdf, !medium.sampled};
    path.seed = next_seed(path.seed);
    path.cone.width += path.cone.spread * travelled;
    path.cone.spread += (1.0f - std::abs(medium.anisotropy)) * kDiffuseSpread;
    walk.spread += travelled / std::sqrt(pdf);
    ray = {position, kInfinity, wi, path.seed, ray.time};
    hit = {};
  }
  walk.alive = false;
  return walk;
}

}  // namespace gatelight::renderer
