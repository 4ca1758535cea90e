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

}  // namespace gatelight::renderer
