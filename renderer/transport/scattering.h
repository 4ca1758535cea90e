#pragma once
// Code that all path-tracing integrators share at a vertex: multiple importance sampling (Veach 1997) of
// lights and directions, shadow rays, absorption, and the seeds of decisions that need no low discrepancy.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/sampling/sampler.h"
#include "renderer/settings/options.h"
#include "renderer/shading/mis_rule.h"
#include "renderer/shading/path_seeds.h"
#include "renderer/surface/shadow_transmittance.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// How much a wholly diffuse bounce widens a ray's cone, radians. The next hit's textures are then read at a
/// level that stays in the cache, and their detail is averaged by the hemisphere anyway.
inline constexpr float kDiffuseSpread = 0.25f;

/// Panes do not count as scattering events. A path ends after this many more surfaces than scattering events.
inline constexpr int kMaxPassed = 1024;

/// The vertex that sampled a ray's direction; panes do not count. The MIS weight of emission that the ray
/// finds depends on it.
struct PreviousVertex {
  Vec3 position = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< the normal that next-event estimation used there
  float travelled = 0.0f;      ///< metres between `position` and the ray's origin: through panes
  float pdf = 0.0f;            ///< of the direction, per solid angle
  /// The direction came from the camera, a delta lobe, or refraction beside unrefracted glass: no light
  /// sample competes.
  bool delta = true;
  int panes = 0;                         ///< between `position` and the ray's origin
  bool without_mis = false;              ///< one of these panes stops shadow rays
  std::uint32_t instance = kNoInstance;  ///< of the vertex, or of the body whose medium it is in

  /// Whether a light sample from `position` could have found the same light.
  bool competes() const { return !delta && !without_mis && panes <= kMaxPanes; }
};

/// MIS weight of the emission of a surface that a ray in `direction` hit.
inline float emission_weight(const World& world, const MisRule& mis, const PreviousVertex& previous,
                             const Hit& hit, const Surface& surface, const Vec3& direction) {
  if (!previous.competes() || surface.unlit) return 1.0f;
  return mis.bsdf_weight(
      previous.pdf, world.lights.pdf_triangle(previous.position, previous.normal, hit.instance, hit.primitive,
                                              direction, previous.travelled + hit.t, hit.time));
}

/// The same for a ray that leaves the scene.
inline float sky_weight(const World& world, const MisRule& mis, const PreviousVertex& previous,
                        const Vec3& direction) {
  if (!previous.competes()) return 1.0f;
  return mis.bsdf_weight(previous.pdf,
                         world.lights.pdf_environment(previous.position, previous.normal, direction));
}

/// The ray from a surface to a light sample. It ends before the light by the rounding error of both ends.
/// With a fraction of the distance instead, occluders close to a far lamp would be missed, and a large lamp
/// nearby would shadow itself.
inline Ray shadow_ray(const Surface& surface, const LightSample& light, std::uint32_t seed,
                      float time = scene::kShutterMiddle) {
  Ray ray;
  ray.origin = surface.spawn(light.wi);
  ray.direction = light.wi;
  ray.t_max = light.distance - (light.offset + 2.0f * surface.offset) / light.cosine;
  ray.seed = shadow_seed(seed);
  ray.time = time;
  ray.mask = ray_mask(scene::kShadowRays);
  if (!(ray.t_max > 0.0f)) ray.t_max = 0.5f * light.distance;
  return ray;
}

}  // namespace gatelight::renderer
