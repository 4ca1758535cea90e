#pragma once
// The door to shading: blocks of up to 16 points of any surface. The kernels shade most, with scalar code for
// the lights that they leave open; scalar code shades the others.

#include <algorithm>
#include <cstdint>
#include <string>

#include "renderer/light/lights.h"
#include "renderer/settings/options.h"
#include "renderer/shading/kernels.h"
#include "renderer/shading/light_arrays.h"
#include "renderer/shading/scalar_shading.h"
#include "renderer/shading/surface_block.h"

namespace gatelight::renderer {

/// The kernels of an instruction set: scalar (SSE2 or the compiler's target), avx2, avx512, or auto,
/// which is the choice of the cache's kernels (simd::select_isa). Throws Unavailable.
const ShadingKernels& choose_shading_kernels(const std::string& isa);

/// Thread-safe after construction. The lights must outlive it.
class Shading {
 public:
  /// sheen: whether some surface has it; its tables take a while to build.
  Shading(const Lights& lights, const LightArrays& arrays, const ShadingKernels& kernels, bool sheen,
          DirectLight direct, MisHeuristic heuristic);
  /// Adds the part of the wide lobes (Bsdf::wide_part) to all results.
  void separate_wide(float min_roughness) {
    context_.separates_wide = true;
    context_.min_roughness = min_roughness;
  }

  /// Shades all lanes: light samples, BSDF values, new directions. The results are in the block.
  void scatter(SurfaceBlock& block) const;
  /// The same for the narrow lobes only, with the albedos of scatter(). Only after separate_wide().
  void scatter_narrow(SurfaceBlock& block, const Roulette& roulette) const;
  /// The light of Lights::sample_delta, and the albedos.
  void delta_light(SurfaceBlock& block) const;
  /// The directional albedos.
  void albedo(SurfaceBlock& block) const;

 private:
  void sample_lights(ShadingBlock& points, LightKinds kinds) const;
  void scatter(SurfaceBlock& block, const ShadingContext& context) const;
  /// `first_placed`: the number of the first placed light.
  void complete_lights(ShadingBlock& block, std::size_t first_placed) const;
  void complete_light(ShadingBlock& block, int lane, std::size_t first_placed) const;

  const Lights& lights_;
  const ShadingKernels& kernels_;
  ShadingContext context_;
  LightArraysPtr delta_lights_;
  bool wide_lights_;
  bool lights_are_complete_;  ///< LightArrays::complete
};

}  // namespace gatelight::renderer
