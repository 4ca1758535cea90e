#pragma once

#include "renderer/surface/surface.h"

namespace gatelight::renderer {

enum class LobeWidths { wide, narrow, both };

/// The widths of the lobes of a surface (Bsdf::has_wide, Bsdf::has_narrow), for light that leaves it towards
/// `wo`. `kernels`: kernels_shade() it, which is decided without its BSDF.
LobeWidths lobe_widths(const Surface& surface, const Vec3& wo, bool kernels, float min_roughness);

}  // namespace gatelight::renderer
