#pragma once
// The light of the clear atmosphere of a round earth, at some wavelengths. Sunlight that air and haze scatter
// once is integrated along the view as in Nishita, Sirai, Tadamura and Nakamae 1993, "Display of the Earth
// Taking into Account Atmospheric Scattering". Light that is scattered more often follows Hillaire 2020, "A
// Scalable and Production Ready Sky and Atmosphere Rendering Technique", section 5.5. Directions are unit,
// with y up at the viewer, who stands at sea level.

#include <vector>

#include "base/math.h"
#include "renderer/light/air_columns.h"
#include "renderer/light/daylight_spectrum.h"

namespace gatelight::renderer {

class Atmosphere {
 public:
  /// The haze of a turbidity (1: hardly any) is that of Preetham, Shirley and Smits 1999, "A Practical
  /// Analytic Model for Daylight", appendix A.1: Angstrom's formula with the exponent 1.3 and beta = 0.04608
  /// turbidity - 0.04586. The ground has the albedo `ground` and lights the air. Parallel (oneTBB), with the
  /// same bits for any number of threads.
  Atmosphere(float turbidity, float ground);

  /// The radiance of the sky in W/(m2 sr nm) in a direction with y >= 0, with the sun in the direction
  /// `to_sun`.
  Spectrum sky_radiance(const Vec3& direction, const Vec3& to_sun) const;
  /// The irradiance of the sun at sea level on a plane that faces it, in W/(m2 nm); zero below the horizon.
  Spectrum sun_irradiance(const Vec3& to_sun) const;

 private:
  Spectrum transmittance(const AirAmounts& amounts) const {
    return (-(amounts.air * air_ + amounts.haze * haze_ + amounts.ozone * ozone_)).exp();
  }
  Spectrum compute_repeated(double radius, double cos_sun, float ground) const;
  /// The light that is scattered for at least the second time, per scattering coefficient: equation 10 of
  /// Hillaire's.
  Spectrum repeated(double radius, double cos_sun) const;

  AirColumns columns_;
  Spectrum air_;    ///< scattering at sea level, per kilometre
  Spectrum haze_;   ///< extinction at sea level, per kilometre
  Spectrum ozone_;  ///< absorption at the peak, per kilometre
  std::vector<Spectrum> repeated_;
};

}  // namespace gatelight::renderer
