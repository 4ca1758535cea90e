#pragma once
// The picture of a film, as the options ask for it.

#include <tbb/task_arena.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/image/shared_rows.h"
#include "renderer/reconstruction/reconstruct.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

struct FinishedPicture {
  Picture picture;
  Reconstruction reconstruction;  ///< what the picture does not hold of it: halves and their noise
  double reconstruct_seconds = 0.0;
  /// Relative RMS, as metrics/estimated_error.h defines it. Empty where pixels have less than two samples.
  std::optional<double> estimated_error;
  double lost_light = 0.0;   ///< with bright samples, of the samples' light
  std::vector<float> alpha;  ///< of the pixels, where the background is apart
};

/// Replaces what the samples found of the light that the camera sees itself (3 floats a pixel) by better
/// values, in the rows of a film.
using SeenLight =
    std::function<void(const PixelRect& rect, const SharedRows& rows, std::vector<float>& seen)>;

/// A half's estimate of the alpha of caught shadows (transport/shadow_catcher.h), for each pixel of `rect`.
using CaughtShadows = std::function<std::vector<float>(const PixelRect& rect, std::size_t half)>;

/// The means of the samples, or with options.reconstruct the finished picture, with the output variables of
/// the options. The film keeps those of film_aovs(options). `better` is called in the arena where the picture
/// is reconstructed.
FinishedPicture finished_picture(const Film& film, const RenderOptions& options, tbb::task_arena& arena,
                                 const SeenLight& better = {}, const CaughtShadows& shadows = {});

/// The same for rows of a picture that several ranks have, with options.reconstruct. `picture` is what
/// Film::resolve() says of them and their margin. The result has picture, reconstruction and alpha of these
/// rows alone; complete() makes the rest. Runs in the caller's arena.
FinishedPicture finished_rows(Picture picture, const SharedRows& rows, const RenderOptions& options,
                              const SeenLight& better, const CaughtShadows& shadows);

/// Puts a picture whose rows are all there before its background, and estimates its error. Runs in the
/// caller's arena. `samples_per_pixel`: Film::samples_per_pixel().
void complete(FinishedPicture& whole, double samples_per_pixel, const RenderOptions& options);

/// The reconstruction alone, with its halves. `picture` is that of finished_rows(). Runs in the caller's
/// arena.
Reconstruction reconstruction_of(Picture picture, const SharedRows& rows, const RenderOptions& options);

/// Its estimated_error alone, without reconstruction.
std::optional<double> error_of_samples(const Film& film, tbb::task_arena& arena);

}  // namespace gatelight::renderer
