#pragma once
// Options of denoising.

#include <string>

#include "renderer/settings/enums.h"

namespace gatelight::renderer {

struct DenoiseOptions {
  DenoiserKind denoiser = DenoiserKind::none;
  Prefilter prefilter = Prefilter::accurate;
  /// The picture is rendered and denoised at this multiple of its width and height, with the same total
  /// number of samples, and then scaled with its pixel filter. 1 without a denoiser.
  int supersampling = 1;
  /// Number of film pixels in a pixel of the picture.
  int film_pixels_per_pixel() const { return supersampling * supersampling; }
  bool temporal = true;  ///< frames of an animation reuse samples of earlier ones (temporal/history.h)
  bool parts = false;    ///< also denoise the layers of passes and light groups
  std::string library;   ///< file or folder of the denoiser; empty: searched (denoise/oidn_library.h)
};

}  // namespace gatelight::renderer
