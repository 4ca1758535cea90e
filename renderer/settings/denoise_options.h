#pragma once
// Options of denoising.

#include <string>

#include "renderer/settings/enums.h"

namespace gatelight::renderer {

struct DenoiseOptions {
  DenoiserKind denoiser = DenoiserKind::none;
  Prefilter prefilter = Prefilter::accurate;
  /// Factor of width and height at which the picture is rendered and denoised, with the same number of
  /// samples in all. It is then scaled by its pixel filter. 1 where nothing is denoised.
  int supersampling = 1;
  /// Pixels of the film in one of the picture.
  int film_pixels_per_pixel() const { return supersampling * supersampling; }
  bool temporal = true;  ///< frames of an animation take over samples of earlier ones (temporal/history.h)
  bool parts = false;    ///< denoises the layers of passes and of light groups too
  std::string library;   ///< of the denoiser: its file or folder; empty: searched (denoise/oidn_library.h)
};

}  // namespace gatelight::renderer
