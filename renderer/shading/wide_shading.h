#pragma once
// Shades blocks of up to 16 points: the kernels, and the scalar code for lights that they do not support.

#include <algorithm>
#include <cstdint>
#include <string>

#include "renderer/light/lights.h"
#include "renderer/settings/options.h"
#include "renderer/shading/kernels.h"
#include "renderer/shading/light_arrays.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

/// The kernels of an instruction set: scalar (SSE2 or the compiler's target), avx2, avx512, or auto,
/// which is the choice of the cache's kernels (simd::select_isa). Throws Unavailable.
const ShadingKernels& choose_shading_kernels(const std::string& isa);

/// Whether the kernels support all lobes of a surface. They do not support refraction into an inside,
/// anisotropic metal and thin films.
inline bool shades_wide(const Surface& surface) {
  const SurfaceMaterial& m = surface.material;
  return !(m.anisotropy > 0.0f) && !(m.iridescence > 0.0f) &&
         (m.thin_walled || !(m.transmission > 0.0f || m.diffuse_transmission > 0.0f));
}

/// Fills a lane's surface. `wo` is unit, away from the surface.
void put_surface(ShadingBlock& block, int lane, const Surface& surface, const Vec3& wo);

/// Thread-safe after construction. The lights must outlive it.
class WideShading {
 public:
  /// sheen: whether some surface has it; its tables take a while to build.
  WideShading(const Lights& lights, const LightArrays& arrays, const ShadingKernels& kernels, bool sheen,
              DirectLight direct, MisHeuristic heuristic);
  /// Adds the part of the wide lobes (Bsdf::wide_part) to all results.
  void separate_wide(float min_roughness) {
    context_.separates_wide = true;
    context_.min_roughness = min_roughness;
  }

  /// Shades all lanes: light samples, BSDF values, new directions. The results are in the block.
  void scatter(ShadingBlock& block) const;
  /// The same for the narrow lobes only, with the albedos of scatter(). Only after separate_wide().
  void scatter_narrow(ShadingBlock& block, const Roulette& roulette) const;
  /// Computes the light of Lights::sample_delta, and the albedos.
  void delta_light(ShadingBlock& block) const;
  /// Computes only the directional albedos.
  void albedo(ShadingBlock& block) const { kernels_.albedo(block, context_); }

 private:
  void sample_lights(ShadingBlock& block) const;
  /// `first_placed`: the number of the first placed light.
  void complete_lights(ShadingBlock& block, std::size_t first_placed) const;
  void complete_light(ShadingBlock& block, int lane, std::size_t first_placed) const;
  void put_light(ShadingBlock& block, int lane, bool delta) const;

  const Lights& lights_;
  const ShadingKernels& kernels_;
  ShadingContext context_;
  LightView delta_lights_;
  bool wide_lights_;
  bool lights_are_complete_;  ///< LightArrays::complete
};

inline Vec3 lane_vector(const float (&a)[3][ShadingBlock::kWidth], int lane) {
  return {a[0][lane], a[1][lane], a[2][lane]};
}
/// The normal that next-event estimation uses: zero on a sheet, which light reaches from both sides.
inline Vec3 light_normal(const ShadingBlock& block, int lane) {
  const float transmission = std::max(block.transmission[lane], block.diffuse_transmission[lane]);
  const bool sheet = transmission * (1.0f - block.metallic[lane]) > 0.0f;
  return sheet ? Vec3(Vec3::Zero()) : lane_vector(block.shading_normal, lane);
}
inline Color lane_color(const float (&a)[3][ShadingBlock::kWidth], int lane) {
  return {a[0][lane], a[1][lane], a[2][lane]};
}

}  // namespace gatelight::renderer
