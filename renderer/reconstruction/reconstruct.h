#pragma once
// The finished picture from samples.

#include <array>
#include <string>
#include <vector>

#include "renderer/image/shared_rows.h"
#include "renderer/reconstruction/sampled_picture.h"

namespace gatelight::renderer {

struct ReconstructionOptions {
  std::string isa = "auto";  ///< of the kernels: auto, scalar, avx2, avx512; all give the same bits
  int rows_at_once = 576;    ///< memory is needed for so many rows; every number gives the same bits
};

struct Reconstruction {
  std::vector<float> color;  ///< 3 floats a pixel, linear, not negative
  std::vector<float> error;  ///< estimated standard error of `color`
  /// What each half of the samples gives, of which `color` is about the mean. Their difference tells the
  /// error of the whole picture better than the sum of `error`, which is smoothed over bright and dark.
  std::array<std::vector<float>, 2> halves;
  /// What noise as that of a half's samples leaves in the other half's picture: one standard deviation a
  /// pixel, of a channel's mean. It is told by that half alone, whose samples weigh the other's.
  std::array<std::vector<float>, 2> noise;
  /// Light of each row that the samples keep, and that is lost with outliers, relative to each other.
  std::vector<std::array<double, 2>> kept_and_lost;
};

/// Of the light of these rows: 0 to 1.
double lost_light(const std::vector<std::array<double, 2>>& kept_and_lost);

/// Rows that processes share begin at multiples of it.
inline constexpr int kRowUnit = 4;
/// A row depends on so many rows around it, in each direction.
inline constexpr int kRowMargin = 64;

/// Fits the samples to the guides in small windows. Both halves are fitted on their own, each with weights
/// that the other one decides: weighted first-order regression (Bitterli et al. 2016, section 4) with
/// collaborative windows. Where the estimated error of the fit is not below that of the samples, the mean of
/// the samples takes over, so the result goes to it as samples grow. Runs in the caller's arena; the same
/// bits for any number of threads. Throws neural::Unavailable for an instruction set that is missing.
Reconstruction reconstruct(const SampledPicture& samples, const ReconstructionOptions& options = {});

/// The same for some rows of a picture, of which `samples` are those at hand: the result has the rows
/// rows.first <= y < rows.end, with the bits that they have in the whole picture.
Reconstruction reconstruct_rows(const SampledPicture& samples, const SharedRows& rows,
                                const ReconstructionOptions& options = {});

}  // namespace gatelight::renderer
