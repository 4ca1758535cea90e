#pragma once
// From light of one wavelength to linear Rec. 709.

#include <Eigen/Core>

#include <cmath>

namespace gatelight::renderer {

/// A Gaussian with a width for each side.
inline double two_sided_gaussian(double x, double height, double centre, double left, double right) {
  const double z = (x - centre) / (x < centre ? left : right);
  return height * std::exp(-0.5 * z * z);
}

/// The CIE 1931 colour matching functions at a wavelength in nanometres, as Wyman, Sloan and Shirley 2013 fit
/// them ("Simple Analytic Approximations to the CIE XYZ Color Matching Functions", equation 4).
inline Eigen::Vector3d color_matching(double nm) {
  return {
      two_sided_gaussian(nm, 1.056, 599.8, 37.9, 31.0) + two_sided_gaussian(nm, 0.362, 442.0, 16.0, 26.7) +
          two_sided_gaussian(nm, -0.065, 501.1, 20.4, 26.2),
      two_sided_gaussian(nm, 0.821, 568.8, 46.9, 40.5) + two_sided_gaussian(nm, 0.286, 530.9, 16.3, 31.1),
      two_sided_gaussian(nm, 1.217, 437.0, 11.8, 36.0) + two_sided_gaussian(nm, 0.681, 459.0, 26.0, 13.8)};
}

/// XYZ to linear Rec. 709 with the white D65 (IEC 61966-2-1).
inline Eigen::Matrix3d rec709_from_xyz() {
  Eigen::Matrix3d m;
  m << 3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252;
  return m;
}

}  // namespace gatelight::renderer
