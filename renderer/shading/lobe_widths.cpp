#include "renderer/shading/lobe_widths.h"

#include <algorithm>

#include "renderer/bsdf/bsdf.h"
#include "renderer/bsdf/bsdf_constants.h"

namespace gatelight::renderer {
namespace {

/// For the surfaces that the kernels shade.
LobeWidths widths_of(const SurfaceMaterial& m, float min_roughness) {
  const auto is_wide = [&](float roughness) {
    return roughness >= std::max(min_roughness, kDeltaRoughness) && roughness <= 1.0f;
  };
  const bool coated = m.clearcoat > 0.0f;
  if (is_wide(m.roughness) && (!coated || is_wide(m.clearcoat_roughness))) return LobeWidths::wide;
  const bool has_wide = is_wide(m.roughness) || (coated && is_wide(m.clearcoat_roughness)) ||
                        (m.metallic < 1.0f && m.transmission < 1.0f) || (m.sheen_color > 0.0f).any();
  return has_wide ? LobeWidths::both : LobeWidths::narrow;
}

}  // namespace

LobeWidths lobe_widths(const Surface& surface, const Vec3& wo, bool kernels, float min_roughness) {
  if (kernels) return widths_of(surface.material, min_roughness);
  const Bsdf bsdf(surface.material, surface.geometric_normal, surface.shading_normal, surface.coat_normal, wo,
                  surface.front);
  if (!bsdf.has_wide(min_roughness)) return LobeWidths::narrow;
  return bsdf.has_narrow(min_roughness) ? LobeWidths::both : LobeWidths::wide;
}

}  // namespace gatelight::renderer
