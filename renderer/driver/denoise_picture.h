#pragma once
// Denoises a picture that was rendered before, by this program or another.

#include <optional>

#include "renderer/denoise/denoiser.h"
#include "renderer/denoise/denoising_layers.h"
#include "renderer/image/picture.h"
#include "renderer/settings/background_options.h"
#include "renderer/settings/enums.h"

namespace gatelight::renderer {

/// The options with which the picture was rendered.
struct DenoisePictureOptions {
  Prefilter prefilter = Prefilter::accurate;
  PixelFilter filter = PixelFilter::blackman_harris;  ///< by which larger samples are scaled
  float filter_width = 0.0f;
  BackgroundOptions background;  ///< put behind the picture where its layers have an alpha
};

/// The picture with its samples, those of samples_of(), denoised in the beauty layer; with the layers of
/// Aov::denoising it is the finished picture, bit for bit. These layers are left out, all others stay. Empty
/// where `progress` cancelled. Runs in the caller's arena. Throws what Denoiser::filter() and put_before()
/// throw.
std::optional<Picture> denoise_picture(Picture picture, const Samples& samples, Denoiser& denoiser,
                                       const DenoisePictureOptions& options,
                                       const DenoiseProgress& progress = {});

}  // namespace gatelight::renderer
