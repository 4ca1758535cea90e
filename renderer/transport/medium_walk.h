#pragma once
// The walk of a path through a medium that scatters, from where it enters to the surface where it leaves: one
// loop, because dense media scatter light hundreds of times.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/medium/equiangular.h"
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

/// A path in the medium `path.inside`, which scatters. See walk_medium().
template <class AddLight>
class MediumWalker {
 public:
  MediumWalker(const PathContext& context, PathState& path, const AddLight& add_light)
      : world_(context.world),
        mis_(context.mis),
        medium_(*path.inside),
        path_(path),
        add_light_(add_light),
        numbers_(path.sampler, static_cast<std::uint32_t>(path.surfaces), hash(path.seed ^ 0x3c6ef372u)) {}

  MediumWalk walk(Ray& ray, Hit& hit, int max_depth, RayCounts& counts) {
    const float bright = path_.throughput.maxCoeff();
    for (;;) {
      const Vec2 u = numbers_.next_2d();
      const ChannelChoice choice(medium_, path_.throughput, u.x());
      const float flight = sample_distance(medium_, choice, u.y());
      // An event closer to a surface than its own rounding might lie behind it, outside of the medium.
      const float reach =
          medium_.box ? kInfinity : flight + 4e-6f * (ray.origin.cwiseAbs().maxCoeff() + flight);
      if (walk_.events > 0) {
        ray.t_max = reach;
        hit = world_.accel.intersect(ray);
        ray.t_max = kInfinity;
        ++counts.bounce;
        ++counts.walk;
      }
      const Span span = medium_.within(ray.origin, ray.direction, hit ? hit.t : kInfinity);
      const bool leaves = medium_.box ? !(flight < span.length()) : hit && hit.t <= reach;
      const bool lost = !leaves && !(flight < kInfinity);  // a channel without extinction, and no surface
      const bool may_scatter = path_.depth < max_depth || walk_.events > 0;
      const bool near_lamps = medium_.box && may_scatter && span.length() > 0.0f && world_.lights.has_local();
      if (near_lamps) sample_lamp(ray, span, choice);
      const float passed = std::min(leaves ? span.length() : flight, 1e30f);
      scale(flight_weight(medium_, choice, passed, !leaves && !lost));
      if (leaves || lost) return walk_;
      if (!may_scatter) break;
      if (++walk_.events == 1) path_.depth += 1;
      if (walk_.events == kMaxWalk) {
        ++counts.ended_walks;
        break;
      }
      // Russian roulette below an eighth of the light that came in.
      const float survival = std::min(1.0f, 8.0f * path_.throughput.maxCoeff() / bright);
      if (!(numbers_.next() < survival)) break;
      scale(Color::Constant(1.0f / survival));

      const float distance = span.begin + flight;
      if (medium_.sampled) sample_light(ray, distance, near_lamps ? &span : nullptr, choice);
      scatter(ray, distance);
    }
    walk_.alive = false;
    return walk_;
  }

 private:
  void scale(const Color& factor) {
    path_.throughput *= factor;
    walk_.factor *= factor;
  }

  /// A light sample at the event at this distance. `span` is that of sample_lamp(); null without it.
  void sample_light(const Ray& ray, float distance, const Span* span, const ChannelChoice& choice) {
    const Vec3 position = ray.origin + distance * ray.direction;
    const Vec2 u = numbers_.next_2d();
    const LightSample light = world_.lights.sample(position, Vec3::Zero(), numbers_.next(), u, ray.time);
    if (!(light.pdf > 0.0f)) return;
    float pdf = light.pdf;
    if (span && light.distance < kInfinity) {
      const Vec3 middle = middle_of(ray, *span);
      const LightSample from_middle = world_.lights.same_point_from(middle, light, position, ray.time);
      const EquiangularDistances near(ray.origin, ray.direction, *span, position + light.distance * light.wi);
      pdf += pdf_of_lamp(from_middle, light, near.pdf(distance)) /
             flight_density(medium_, choice, distance - span->begin);
    }
    add(ray, position, light, Color::Constant(1.0f / pdf), walk_.events);
  }

  /// Light that reaches the ray from a lamp nearby and is scattered there, without an event of the path. The
  /// lamp is chosen for the middle of the `span`, then the distance. Shares each lamp and distance with
  /// sample_light() by the balance heuristic.
  void sample_lamp(const Ray& ray, const Span& span, const ChannelChoice& choice) {
    const Vec3 middle = middle_of(ray, span);
    const Vec2 u = numbers_.next_2d();
    const LightSample from_middle = world_.lights.sample(middle, Vec3::Zero(), numbers_.next(), u, ray.time);
    const float u_distance = numbers_.next();
    if (!(from_middle.pdf > 0.0f) || !(from_middle.distance < kInfinity)) return;
    const EquiangularDistances near(ray.origin, ray.direction, span,
                                    middle + from_middle.distance * from_middle.wi);
    const float distance = std::clamp(near.sample(u_distance), span.begin, span.end);
    const Vec3 position = ray.origin + distance * ray.direction;
    const LightSample light = world_.lights.same_point_from(position, from_middle, middle, ray.time);
    if (!(light.radiance > 0.0f).any()) return;
    const float flight = distance - span.begin;
    const float pdf = light.pdf * flight_density(medium_, choice, flight) +
                      pdf_of_lamp(from_middle, light, near.pdf(distance));
    if (!(pdf > 0.0f)) return;
    const Color scattering = medium_.albedo * medium_.extinction * (-medium_.extinction * flight).exp();
    add(ray, position, light, scattering / pdf, walk_.events + 1);
  }

  static Vec3 middle_of(const Ray& ray, const Span& span) {
    return ray.origin + 0.5f * (span.begin + span.end) * ray.direction;
  }

  /// The density with which sample_lamp() finds this light sample of an event, and its distance.
  static float pdf_of_lamp(const LightSample& from_middle, const LightSample& light, float distance_pdf) {
    const float pdf = from_middle.pdf * distance_pdf;
    if (light.delta || !(pdf > 0.0f)) return pdf;
    const float ratio = light.distance / from_middle.distance;
    return pdf * ratio * ratio * from_middle.cosine / light.cosine;
  }

  void add(const Ray& ray, const Vec3& position, const LightSample& light, const Color& factor, int event) {
    const float value = phase(medium_.anisotropy, ray.direction.dot(light.wi));
    const float weight = value * (light.delta ? 1.0f : mis_.light_weight(light.pdf, value));
    Ray shadow{
        position, light.distance, light.wi, shadow_seed(path_.seed), ray.time, ray_mask(scene::kShadowRays)};
    if (!world_.light_rules.empty()) {
      const LightRule& rule = world_.light_rules.of_light(light.light);
      if (!rule.lights(path_.body) || !(rule.rays & scene::kVolumeRays)) return;
      shadow.mask = rule.shadow_mask;
    }
    if (light.distance < kInfinity) shadow.t_max -= light.offset / light.cosine;
    shadow.inside = &medium_;
    add_light_(Color(walk_.factor * light.radiance * (factor * weight)), shadow, light.light, event);
  }

  /// Replaces the ray by that of the event at this distance.
  void scatter(Ray& ray, float distance) {
    const Vec3 position = ray.origin + distance * ray.direction;
    const Vec3 wi = sample_phase(medium_.anisotropy, ray.direction, numbers_.next_2d());
    const float pdf = phase(medium_.anisotropy, ray.direction.dot(wi));
    path_.previous = {position, Vec3::Zero(), 0.0f, pdf, !medium_.sampled};
    path_.previous.instance = path_.body;
    path_.mask = ray_mask(scene::kVolumeRays);
    path_.reach = kInfinity;
    path_.seed = next_seed(path_.seed);
    path_.cone.width += path_.cone.spread * distance;
    path_.cone.spread += (1.0f - std::abs(medium_.anisotropy)) * kDiffuseSpread;
    walk_.spread += distance / std::sqrt(pdf);
    ray = {position, kInfinity, wi, path_.seed, ray.time, path_.mask};
  }

  const World& world_;
  const MisRule& mis_;
  const ScatteringMedium& medium_;
  PathState& path_;
  const AddLight& add_light_;
  WalkNumbers numbers_;
  MediumWalk walk_;
};

/// Walks through the medium `path.inside`, which scatters. `ray` and `hit`: the path's ray with its nearest
/// hit; afterwards those with which it leaves. add_light(light, shadow ray, number of the light, event) is
/// called for each light sample: `light` is its radiance at the walk's beginning if nothing is in between,
/// and events are counted from 1.
template <class AddLight>
MediumWalk walk_medium(const PathContext& context, PathState& path, Ray& ray, Hit& hit, int max_depth,
                       RayCounts& counts, const AddLight& add_light) {
  return MediumWalker<AddLight>(context, path, add_light).walk(ray, hit, max_depth, counts);
}

}  // namespace gatelight::renderer
