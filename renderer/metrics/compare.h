#pragma once
// Errors of one picture against another, over red, green and blue of their beauty layers.

#include <cstdint>

#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

/// Means are over pixels and channels, in double precision and in the order of the pixels. A pixel that is
/// not finite in one of the pictures is counted, and left out of all other members.
struct ErrorMetrics {
  double mse = 0.0;
  double rel_mse = 0.0;                   ///< mean of squared error / (squared reference + 1e-2)
  double psnr = 0.0;                      ///< in dB for a peak of kPsnrPeak; infinity where mse is 0
  double mean_error = 0.0;                ///< mean absolute difference
  double max_error = 0.0;                 ///< largest absolute difference
  double mean_difference = 0.0;           ///< mean of test minus reference: the bias
  std::uint64_t pixels = 0;               ///< number of compared pixels
  std::uint64_t nonfinite_reference = 0;  ///< pixels with NaN or infinity
  std::uint64_t nonfinite_test = 0;
};

/// Display white. Radiance above it is treated like any other.
inline constexpr double kPsnrPeak = 1.0;
inline constexpr double kRelMseEpsilon = 1e-2;

/// Alpha is ignored. A beauty layer of one channel is grey. Throws what require_comparable() throws. All
/// errors are NaN when no pixel is finite in both pictures.
ErrorMetrics compare_pictures(const NamedPicture& reference, const NamedPicture& test);

/// Two pictures of the same view with independent noise.
struct Halves {
  NamedPicture first;
  NamedPicture second;
};

/// The mean of (t1 - r1)(t2 - r2) / (r^2 + 1e-2) over the pixels that are finite in all four pictures, with r
/// the mean of r1 and r2. If the noise of the four pictures is independent, this estimates the relative
/// squared error that the test keeps with infinitely many samples. The rel_mse of a picture is this value
/// plus its variance. The estimate may be negative by chance. The noise of r enters only in the fourth power.
/// Throws what require_comparable() throws. NaN when no pixel is finite.
double squared_bias(const Halves& reference, const Halves& test);

/// The square root of each pixel's relative squared error as a colour: black 0, violet 0.1, red 0.25, yellow
/// 0.5, white 1 and more, green where a value is not finite. A PNG shows these colours when it is written
/// without exposure and curve.
Picture error_map(const NamedPicture& reference, const NamedPicture& test);

}  // namespace gatelight::renderer
