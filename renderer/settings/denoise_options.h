#pragma once
// How the noise is taken out of a picture.

#include <string>

#include "renderer/settings/choices.h"

namespace gatelight::renderer {

struct DenoiseOptions {
  DenoiserKind denoiser = DenoiserKind::none;
  /// Albedo and normal are denoised first, and a larger network reads them.
  bool clean_guides = true;
  /// The picture is rendered and denoised at so many times its width and height, with as many samples in all,
  /// and then scaled by its pixel filter. 1 where nothing is denoised.
  int supersampling = 1;
  std::string library;  ///< of the denoiser: its file or folder; empty: searched (denoise/oidn_library.h)
};

}  // namespace gatelight::renderer
