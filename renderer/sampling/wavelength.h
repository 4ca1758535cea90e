#pragma once
// Wavelengths for paths through media that disperse light.

#include <algorithm>

#include "base/math.h"

namespace gatelight::renderer {

struct Wavelength {
  float nm = 0.0f;
  /// The colour of white light at this wavelength. Its mean over all samples is one, so that light which does
  /// not depend on the wavelength stays white. Colours of the spectrum that Rec. 709 cannot represent are
  /// clamped at zero.
  Color color{1.0f, 1.0f, 1.0f};
};

/// `u` in [0, 1). Wavelengths are drawn by the sum of the three channels, so the sum of `color` is always
/// three.
Wavelength sample_wavelength(float u);

/// The index of refraction at a wavelength: Cauchy's equation with two terms through the index `ior` at 587.6
/// nm, and 20 / `dispersion` as the Abbe number (KHR_materials_dispersion). At least one.
inline float dispersed_ior(float ior, float dispersion, float nm) {
  return std::max(ior + (ior - 1.0f) * (dispersion / 20.0f) * (523655.0f / (nm * nm) - 1.5168f), 1.0f);
}

}  // namespace gatelight::renderer
