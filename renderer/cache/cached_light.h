#pragma once
// Defines the cached light. A vertex x of a path reflects towards wo
//
//     R(x, wo) = integral of f(wo, wi) |cos| (E(wi) + S(wi)) dwi,
//
// where E is the emission of the surface or sky in direction wi (seen through panes), S is the light that
// this surface reflects, and f = wide lobes + narrow lobes (Bsdf::wide_part). The cache answers with the part
// H of R, divided by the reflectance of the wide lobes:
//
//     all        wide (E + S)
//     no_delta   wide (E + S) without the light of punctual lights, which only light samples find
//     indirect   wide S
//
// Targets of records, ends of paths in the cache and pictures all use the terms below, so they cannot
// disagree: R = H + the rest, for every choice.

#include "renderer/light/lights.h"
#include "renderer/settings/cache_options.h"

namespace gatelight::renderer {

struct CachedLight {
  CachedComponent component = CachedComponent::no_delta;

  /// Whether the wide lobes' share of a light sample is in H.
  bool light_sample(bool delta) const {
    return component == CachedComponent::all || (component == CachedComponent::no_delta && !delta);
  }
  /// Whether the wide lobes' share of E, found by a direction of the BSDF, is in H.
  bool emission() const { return component != CachedComponent::indirect; }
  // The wide lobes' share of S is always in H; light of the narrow lobes never is.
};

/// The factor from an answer to radiance: the wide lobes' directional albedo, bounded from below because
/// targets are divided by it.
inline Color cache_reflectance(const Color& wide_albedo) {
  constexpr float kMin = 1e-3f;
  return wide_albedo.max(kMin);
}
/// Whether the albedo of the wide lobes is large enough to learn their light.
inline bool worth_caching(const Color& wide_albedo) {
  return wide_albedo.maxCoeff() >= 1e-3f;
}

}  // namespace gatelight::renderer
