#pragma once
// Shading by the scalar BSDF, for surfaces that the kernels do not support: refracting glass, anisotropic
// metal, thin films, panes that a path only passes. Reads and writes the block as the kernels do.

#include "renderer/light/lights.h"
#include "renderer/shading/kernels.h"
#include "renderer/shading/surface_block.h"

namespace gatelight::renderer {

enum class LightKinds : std::uint8_t {
  all,
  delta,  ///< lights that BSDF sampling cannot find
};

/// Samples a light for a lane: Lights::sample or sample_delta.
void sample_light(const Lights& lights, LightKinds kinds, ShadingBlock& block, int lane);

/// Shading::albedo, delta_light and scatter.
void scalar_albedo(SurfaceBlock& block, const ShadingContext& context);
void scalar_delta_light(SurfaceBlock& block, const Lights& lights, const ShadingContext& context);
void scalar_scatter(SurfaceBlock& block, const Lights& lights, const ShadingContext& context);

}  // namespace gatelight::renderer
