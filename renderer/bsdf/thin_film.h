#pragma once
// A thin film on the microfacets (KHR_materials_iridescence): Belcour and Barla 2017, "A Practical Extension
// to Microfacet Theory for the Modeling of Varying Iridescence", with the simplifications of the extension's
// text: Schlick's curve at both interfaces, no polarisation, two orders of interference.

#include "base/math.h"

namespace gatelight::renderer {

struct ThinFilm {
  float weight = 0.0f;       ///< of the film's reflectance; the rest is the reflectance without it
  float ior = 1.3f;          ///< at least 1
  float thickness = 400.0f;  ///< nanometres
  float outside_ior = 1.0f;  ///< of the medium above the film

  /// The reflectance in linear Rec. 709 of a film on a base with the reflectance `base_f0` at normal
  /// incidence, in [0, 1]. `cosine` is the angle outside.
  Color reflectance(float cosine, const Color& base_f0) const;
  /// The change that the film makes to Schlick's reflectance from base_f0 to base_f90.
  Color change(float cosine, const Color& base_f0, float base_f90) const;
};

}  // namespace gatelight::renderer
