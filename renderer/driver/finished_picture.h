#pragma once
// Makes the picture of a film by its options.

#include <tbb/task_arena.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "renderer/denoise/denoise.h"
#include "renderer/film/film.h"
#include "renderer/film/scale_down.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

struct FinishedPicture {
  Picture picture;
  bool denoised = false;
  bool stopped = false;  ///< denoising was cancelled
  std::string failure;   ///< why it is not denoised although it should be; else empty
  double denoise_seconds = 0.0;
  /// Relative RMS, as metrics/estimated_error.h defines it. Empty where pixels have less than two samples.
  std::optional<double> estimated_error;
};

/// The alpha of caught shadows (transport/shadow_catcher.h), for each pixel of `rect`.
using CaughtShadows = std::function<std::vector<float>(const PixelRect& rect)>;

/// How a film becomes a picture.
struct Finishing {
  const RenderOptions& options;           ///< of the film
  Denoiser* denoiser = nullptr;           ///< null: the means of the samples
  ScaleDown scale;                        ///< from the film to the picture
  std::optional<PixelRect> noisy_guides;  ///< NoisyPicture::noisy_guides
  CaughtShadows shadows;                  ///< empty: none
  DenoiseProgress progress;               ///< false cancels denoising
  std::vector<Layer> motion;              ///< of Aov::motion and Aov::motion_next
  /// Changes what is denoised, before a background is put behind it; empty: not needed. There is no estimate
  /// of the error then.
  std::function<void(DenoisedRows& denoised)> after_denoising;
};

/// The finished picture with the output variables of the options. The film keeps film_contents(options).
/// Where denoising fails or is cancelled, the picture is that of the samples' means.
FinishedPicture finished_picture(const Film& film, const Finishing& finishing, tbb::task_arena& arena);

/// Only its estimated_error; also empty where denoising fails.
std::optional<double> error_of_picture(const Film& film, const Finishing& finishing, tbb::task_arena& arena);

}  // namespace gatelight::renderer
