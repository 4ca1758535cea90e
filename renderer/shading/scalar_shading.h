#pragma once
// Shading by the scalar BSDF, for surfaces that the kernels do not support: refracting glass, anisotropic
// metal, thin films, panes that a path only passes. Reads and writes the block as the kernels do.

#include "renderer/light/lights.h"
#include "renderer/shading/kernels.h"
#include "renderer/shading/surface_block.h"

namespace gatelight::renderer {

/// Samples a light for a lane: Lights::sample, or sample_delta.
void sample_light(const Lights& lights, ShadingBlock& block, int lane, bool delta);

/// ShadingKernels::albedo, light and scatter.
void scalar_albedo(SurfaceBlock& block, const ShadingContext& context);
void scalar_light(SurfaceBlock& block, const ShadingContext& context);
void scalar_scatter(SurfaceBlock& block, const ShadingContext& context);

}  // namespace gatelight::renderer
