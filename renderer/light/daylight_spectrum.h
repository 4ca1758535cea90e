#pragma once
// Light as power at a few wavelengths, and its colour.

#include <Eigen/Core>

#include "base/math.h"

namespace gatelight::renderer {

/// From 380 to 720 nm in steps of 20 nm.
inline constexpr int kWavelengths = 18;
inline constexpr double kFirstWavelength = 380.0;  ///< nanometres
inline constexpr double kWavelengthStep = 20.0;    ///< nanometres
using Spectrum = Eigen::Array<float, kWavelengths, 1>;

/// The function of the wavelength in nanometres at all wavelengths.
template <class Function>
Spectrum make_spectrum(const Function& function) {
  Spectrum spectrum;
  for (int i = 0; i < kWavelengths; ++i)
    spectrum[i] = static_cast<float>(function(kFirstWavelength + kWavelengthStep * i));
  return spectrum;
}

/// The irradiance of the sun outside the atmosphere at the mean distance of the earth, in W/(m2 nm). After
/// Neckel and Labs 1981 in the table of Bird and Riordan 1984 ("Simple Solar Spectral Model").
const Spectrum& solar_irradiance();

/// The absorption of ozone per centimetre of the gas at standard pressure and temperature: Leckner 1978, "The
/// Spectral Distribution of Solar Radiation at the Earth's Surface".
const Spectrum& ozone_absorption();

/// From radiance in W/(m2 sr nm) to linear Rec. 709 with the white D65 (sampling/color_matching.h). A
/// luminance of 100 000 lux / pi, that of a white surface in full daylight, becomes 1. The same for
/// irradiance: 100 000 lux become pi. Channels may be negative.
Eigen::Array3f daylight_color(const Spectrum& spectrum);

}  // namespace gatelight::renderer
