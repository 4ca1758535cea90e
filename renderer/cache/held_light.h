#pragma once
// What the cache stands for, in one place. A vertex x of a path reflects towards wo
//
//     R(x, wo) = integral of f(wo, wi) |cos| (E(wi) + S(wi)) dwi,
//
// E what the surface or sky met by wi emits (panes are looked through), S what the surface met by wi reflects
// in turn, and f = wide lobes + narrow lobes (Bsdf::wide_part). The cache answers with the part H of R, over
// the reflectance of the wide lobes:
//
//     all        wide (E + S)
//     no_delta   wide (E + S) without the light of punctual lights, which only light samples find
//     indirect   wide S
//
// A record's target, the end of a path in the cache and a picture are all made of the terms below, so that
// they cannot disagree: R = H + the rest, for every choice.

#include "renderer/light/lights.h"
#include "renderer/settings/cache_options.h"

namespace gatelight::renderer {

struct HeldLight {
  CacheHolds holds = CacheHolds::no_delta;

  /// Whether the wide lobes' share of a light sample is in H.
  bool light_sample(bool delta) const {
    return holds == CacheHolds::all || (holds == CacheHolds::no_delta && !delta);
  }
  /// Whether the wide lobes' share of E, found by a direction of the BSDF, is in H.
  bool emission() const { return holds != CacheHolds::indirect; }
  // The wide lobes' share of S always is; nothing of the narrow lobes ever is.
};

/// The factor between an answer and radiance: the wide lobes' directional albedo, kept from zero so that
/// targets can be divided by it.
inline Color cache_reflectance(const Color& wide_albedo) {
  constexpr float kLeast = 1e-3f;
  return wide_albedo.max(kLeast);
}
/// Below this there is nothing to learn or to answer.
inline bool worth_caching(const Color& wide_albedo) {
  return wide_albedo.maxCoeff() >= 1e-3f;
}

}  // namespace gatelight::renderer
