#pragma once
// Up to 16 points of surfaces that are shaded together, as a structure of arrays. Plain data: the kernels,
// which are compiled once for each instruction set, use nothing else of the renderer.

#include <cstdint>

#include "renderer/settings/enums.h"

namespace gatelight::renderer {

/// The state of a lane's light sample.
enum class LaneLight : std::uint32_t {
  none,         ///< no light can reach the point
  done,         ///< the sample is complete
  triangle,     ///< complete but for the texture of the emissive triangle `light`, at `light_point`
  profile,      ///< complete but for the profile of the placed light `light`
  environment,  ///< a picture is sampled with `light_point`; `light_pdf` is the probability of the choice
};

/// A lane is a point. Vectors are in world space; directions are unit and point away from the surface.
struct alignas(64) ShadingBlock {
  static constexpr int kWidth = 16;
  using Floats = float[kWidth];
  using Words = std::uint32_t[kWidth];

  int count = 0;                             ///< lanes in use; the others keep their old content
  SamplerKind sampler = SamplerKind::sobol;  ///< of all lanes

  // The surface: members of Surface and SurfaceMaterial. Transmission is that of a thin sheet.
  alignas(64) Floats position[3], geometric_normal[3], shading_normal[3], coat_normal[3], wo[3], offset;
  Floats base_color[3], metallic, roughness, ior, specular, specular_color[3], transmission;
  Floats diffuse_transmission, diffuse_transmission_color[3];  // the colour is valid for a share above zero
  Floats clearcoat, clearcoat_roughness, sheen_color[3], sheen_roughness;
  // The path.
  Words sampler_key, sampler_index;
  Words dimensions;  ///< first sampler dimension of the vertex
  Words seed;
  Floats time;                   ///< of the shutter
  Words events_before_roulette;  ///< scattering events left until Russian roulette applies; signed
  Floats throughput[3];          ///< for Russian roulette

  // The light sample: its state, and the members of LightSample.
  Words light_state;  ///< LaneLight
  Words light;        ///< LightSample::light
  Words light_is_delta;
  Floats light_point[2];
  Floats light_direction[3], light_distance, light_radiance[3], light_pdf, light_offset, light_cosine;

  // The BSDF towards the light, times radiance, MIS weight and one over the pdf; zero without light.
  Floats direct[3];
  Floats wide_direct[3];  ///< part of the wide lobes, where ShadingContext::separates_wide
  // The shadow ray.
  Floats shadow_origin[3], shadow_length;
  Words shadow_seed;

  Floats albedo[3];
  Floats wide_albedo[3];  ///< of the wide lobes
  // The sampled direction: DirectionSample, and the next ray.
  Words alive;  ///< 0: the path ends
  Words is_delta, transmitted;
  Floats wi[3], weight[3], pdf, spread, survival;
  Floats wide_weight[3];  ///< of the wide lobes for this direction; delta lobes have none
  Floats next_origin[3];
  Words next_seed;
};

}  // namespace gatelight::renderer
