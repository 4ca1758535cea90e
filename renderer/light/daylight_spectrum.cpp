#include "renderer/light/daylight_spectrum.h"

#include <cmath>

#include "renderer/sampling/color_matching.h"

namespace gatelight::renderer {
namespace {

using ColorWeights = Eigen::Matrix<float, 3, kWavelengths>;

ColorWeights make_weights() {
  constexpr double kLumensPerWatt = 683.0;
  constexpr double kUnit = 100000.0 / M_PI;  // candela per square metre
  ColorWeights weights;
  for (int i = 0; i < kWavelengths; ++i) {
    const Eigen::Vector3d xyz = color_matching(kFirstWavelength + kWavelengthStep * i);
    const Eigen::Vector3d rgb = rec709_from_xyz() * xyz * (kWavelengthStep * kLumensPerWatt / kUnit);
    weights.col(i) = rgb.cast<float>();
  }
  return weights;
}

Spectrum times(const float (&values)[kWavelengths], float factor) {
  return factor * Eigen::Map<const Spectrum>(values);
}

}  // namespace

const Spectrum& solar_irradiance() {
  // In W/(m2 um); values between the table's wavelengths are interpolated.
  static const float table[kWavelengths] = {1104, 1479, 1740, 1837, 2043, 2027, 1909, 1831, 1898,
                                            1866, 1809, 1752, 1693, 1606, 1526, 1470, 1410, 1368};
  static const Spectrum spectrum = times(table, 1e-3f);
  return spectrum;
}

const Spectrum& ozone_absorption() {
  static const float table[kWavelengths] = {0.0f,   0.0f,   0.0f,   0.003f, 0.006f, 0.014f,
                                            0.030f, 0.048f, 0.075f, 0.103f, 0.120f, 0.125f,
                                            0.105f, 0.079f, 0.057f, 0.036f, 0.023f, 0.014f};
  static const Spectrum spectrum = times(table, 1.0f);
  return spectrum;
}

Eigen::Array3f daylight_color(const Spectrum& spectrum) {
  static const ColorWeights weights = make_weights();
  const Eigen::Vector3f color = weights * spectrum.matrix();
  return color.array();
}

}  // namespace gatelight::renderer
