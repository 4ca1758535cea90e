#pragma once
// Code that all path-tracing integrators share at a vertex: multiple importance sampling (Veach 1997) of
// lights and directions, shadow rays, absorption, and the seeds of decisions that need no low discrepancy.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/sampling/sampler.h"
#include "renderer/settings/options.h"
#include "renderer/surface/shadow_transmittance.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// How much a wholly diffuse bounce widens a ray's cone, radians. The next hit's textures are then read at a
/// level that stays in the cache, and their detail is averaged by the hemisphere anyway.
inline constexpr float kDiffuseSpread = 0.25f;

/// Panes do not count as scattering events. A path ends after this many more surfaces than scattering events.
inline constexpr int kMaxPassed = 1024;

/// MIS weights of light sampling and BSDF sampling.
struct MisRule {
  DirectLight direct = DirectLight::mis;
  MisHeuristic heuristic = MisHeuristic::power;

  float light_weight(float light_pdf, float bsdf_pdf) const {
    return weight(DirectLight::nee, DirectLight::bsdf, light_pdf, bsdf_pdf);
  }
  float bsdf_weight(float bsdf_pdf, float light_pdf) const {
    if (light_pdf <= 0.0f) return 1.0f;
    return weight(DirectLight::bsdf, DirectLight::nee, bsdf_pdf, light_pdf);
  }

 private:
  float weight(DirectLight mine, DirectLight other, float pdf, float other_pdf) const {
    if (direct == mine) return 1.0f;
    if (direct == other) return 0.0f;
    const float ratio = other_pdf / pdf;
    return heuristic == MisHeuristic::balance ? 1.0f / (1.0f + ratio) : 1.0f / (1.0f + ratio * ratio);
  }
};

/// The vertex that sampled a ray's direction; panes do not count. The MIS weight of emission that the ray
/// finds depends on it.
struct Departure {
  Vec3 position = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< the normal that next-event estimation used there
  float travelled = 0.0f;      ///< metres between `position` and the ray's origin: through panes
  float pdf = 0.0f;            ///< of the direction, per solid angle
  /// The direction came from the camera, a delta lobe, or refraction beside unrefracted glass: no light
  /// sample competes.
  bool delta = true;
  int panes = 0;             ///< between `position` and the ray's origin
  bool without_mis = false;  ///< one of these panes stops shadow rays

  /// Whether a light sample from `position` could have found the same light.
  bool competes() const { return !delta && !without_mis && panes <= kMaxPanes; }
};

/// MIS weight of the emission of a surface that a ray in `direction` hit.
inline float emission_weight(const World& world, const MisRule& mis, const Departure& departure,
                             const Hit& hit, const Surface& surface, const Vec3& direction) {
  if (!departure.competes() || surface.unlit) return 1.0f;
  return mis.bsdf_weight(departure.pdf,
                         world.lights.pdf_triangle(departure.position, departure.normal, hit.instance,
                                                   hit.primitive, direction, departure.travelled + hit.t));
}

/// The same for a ray that leaves the scene.
inline float sky_weight(const World& world, const MisRule& mis, const Departure& departure,
                        const Vec3& direction) {
  if (!departure.competes()) return 1.0f;
  return mis.bsdf_weight(departure.pdf,
                         world.lights.pdf_environment(departure.position, departure.normal, direction));
}

/// The ray from a surface to a light sample. It ends before the light by the rounding error of both ends.
/// With a fraction of the distance instead, occluders close to a far lamp would be missed, and a large lamp
/// nearby would shadow itself.
inline Ray shadow_ray(const Surface& surface, const LightSample& light, std::uint32_t seed) {
  Ray ray;
  ray.origin = surface.spawn(light.wi);
  ray.direction = light.wi;
  ray.t_max = light.distance - (light.offset + 2.0f * surface.offset) / light.cosine;
  ray.seed = hash(seed ^ 0x5bd1e995u);
  if (!(ray.t_max > 0.0f)) ray.t_max = 0.5f * light.distance;
  return ray;
}

/// Survival probability of Russian roulette: the square root of the throughput. In bright rooms, where long
/// paths carry much light, the throughput itself costs more noise than it saves time (Country Kitchen: a
/// tenth more noise in the same time). The throughput leaves out BsdfSample::radiance_scale, which is no
/// loss.
inline float survival_probability(const Color& throughput) {
  return std::min(0.95f, std::sqrt(throughput.maxCoeff()));
}

/// Random numbers for a path's decisions at a vertex, from its current seed.
inline float roulette_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x68bc21ebu));
}
inline float texture_level_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x2545f491u));
}
inline float shadow_roulette_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x1b873593u));
}
inline float boundary_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x7f4a7c15u));
}
inline std::uint32_t next_seed(std::uint32_t seed) {
  return hash(seed + 0x9e3779b9u);
}

}  // namespace gatelight::renderer
