#pragma once
// How far one picture is from another, over the red, green and blue of their beauty layers.

#include <cstdint>

#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

/// Means run over pixels and channels, in double precision and in the order of the pixels. A pixel that is
/// not finite in one of the pictures is counted and left out of all the others.
struct ErrorMetrics {
  double mse = 0.0;
  double rel_mse = 0.0;                   ///< squared error over (squared reference + 1e-2)
  double psnr = 0.0;                      ///< dB for a peak of kPsnrPeak; infinity where the mse is 0
  double mean_error = 0.0;                ///< of the absolute difference
  double max_error = 0.0;                 ///< of the absolute difference
  double mean_difference = 0.0;           ///< test minus reference: the bias
  std::uint64_t pixels = 0;               ///< compared
  std::uint64_t nonfinite_reference = 0;  ///< pixels with NaN or infinity
  std::uint64_t nonfinite_test = 0;
};

/// Display white; radiance above it is not special.
inline constexpr double kPsnrPeak = 1.0;
inline constexpr double kRelMseEpsilon = 1e-2;

/// Alpha is ignored; a beauty layer of one channel is grey. Throws CompareError when the sizes differ, when
/// one is grey and one has colours, or when a picture has no beauty layer. Where no pixel is finite in both,
/// all errors are NaN.
ErrorMetrics compare_pictures(const NamedPicture& reference, const NamedPicture& test);

/// Two pictures of the same with independent noise.
struct Halves {
  NamedPicture first;
  NamedPicture second;
};

/// Mean of (t1 - r1)(t2 - r2) / (r^2 + 1e-2), r the mean of r1 and r2, over the pixels that are finite in all
/// four: where the noise of each is independent of that of the others, this is the relative squared error
/// that the test would keep with infinitely many samples. The rel_mse of a picture is this plus its variance.
/// May be negative by chance. (r is noisy too, which enters in the fourth power of the references' noise
/// only.) Throws CompareError as compare_pictures() does; NaN where no pixel is finite.
double squared_bias(const Halves& reference, const Halves& test);

/// Per pixel the square root of its relative squared error, as a colour: black 0, violet 0.1, red 0.25,
/// yellow 0.5, white 1 and more; green where a value is not finite. Shows these colours when it is written as
/// a PNG without exposure and curve.
Picture error_map(const NamedPicture& reference, const NamedPicture& test);

}  // namespace gatelight::renderer
