#pragma once
// How the noise is taken out of a picture.

#include <string>

#include "renderer/settings/choices.h"

namespace gatelight::renderer {

struct DenoiseOptions {
  DenoiserKind denoiser = DenoiserKind::none;
  Prefilter prefilter = Prefilter::accurate;
  /// The picture is rendered and denoised at so many times its width and height, with as many samples in all,
  /// and then scaled by its pixel filter. 1 where nothing is denoised.
  int supersampling = 1;
  /// Pixels of the film in one of the picture.
  int parts() const { return supersampling * supersampling; }
  std::string library;  ///< of the denoiser: its file or folder; empty: searched (denoise/oidn_library.h)
};

}  // namespace gatelight::renderer
