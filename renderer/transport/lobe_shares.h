#pragma once
// The shares of the diffuse lobes in the results of shading, for the render passes.

#include "renderer/film/light_parts.h"
#include "renderer/transport/path_state.h"

namespace gatelight::renderer {

/// Shading::separate_wide() with this roughness separates the diffuse lobes: the diffuse base on both sides
/// and sheen. No microfacets are as wide.
inline constexpr float kOnlyDiffuse = 2.0f;

inline LobeShare::Rest rest_of(bool transmitted) {
  return transmitted ? LobeShare::Rest::transmission : LobeShare::Rest::glossy;
}

/// Of the light sample of a lane that was shaded with kOnlyDiffuse.
inline LobeShare share_of_light(const ShadingBlock& p, int lane) {
  return {share_of(lane_color(p.wide_direct, lane), lane_color(p.direct, lane)),
          rest_of(light_is_behind(p, lane))};
}

/// The same of its sampled direction.
inline LobeShare share_of_direction(const ShadingBlock& p, int lane) {
  const Color diffuse = p.is_delta[lane] != 0 ? Color(Color::Zero()) : lane_color(p.wide_weight, lane);
  return {share_of(diffuse, lane_color(p.weight, lane)), rest_of(p.transmitted[lane] != 0)};
}

/// Of a light sample, what lobes reflect whose rays would see the light: the share of each channel. `lobes`
/// become those of the rest.
[[gnu::noinline, gnu::cold]] inline Color keep_visible(LobeShare& lobes, scene::RayKinds rays) {
  const bool transmitted = lobes.rest == LobeShare::Rest::transmission;
  const scene::RayKinds of_diffuse = transmitted ? scene::kTransmissionRays : scene::kDiffuseRays;
  const scene::RayKinds of_rest = transmitted ? scene::kTransmissionRays : scene::kGlossyRays;
  const Color diffuse = (rays & of_diffuse) != 0 ? lobes.diffuse : Color(Color::Zero());
  const Color kept = diffuse + ((rays & of_rest) != 0 ? Color(1.0f - lobes.diffuse) : Color(Color::Zero()));
  lobes.diffuse = share_of(diffuse, kept);
  return kept;
}

/// Chooses the lobe that a sampled direction follows by its share of the light, so that the ray is of one
/// kind. `u` is in [0, 1).
[[gnu::noinline, gnu::cold]] inline void choose_lobe(LobeShare& lobes, DirectionSample& sampled, float u) {
  const Color diffuse = lobes.diffuse * sampled.weight;
  const float whole = luminance(sampled.weight);
  const float share = whole > 0.0f ? luminance(diffuse) / whole : 0.0f;
  const bool is_diffuse = u < share;
  sampled.weight = is_diffuse ? Color(diffuse / share) : Color((sampled.weight - diffuse) / (1.0f - share));
  lobes.diffuse.setConstant(is_diffuse ? 1.0f : 0.0f);
  if (sampled.transmitted) {
    sampled.kind = scene::kTransmissionRays;
  } else {
    sampled.kind = is_diffuse ? scene::kDiffuseRays : scene::kGlossyRays;
  }
}

}  // namespace gatelight::renderer
