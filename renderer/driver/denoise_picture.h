#pragma once
// Denoises a picture that was rendered before, by this program or another.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/denoise/denoiser.h"
#include "renderer/denoise/layers_to_denoise.h"
#include "renderer/image/image_write.h"
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

/// The picture with its samples denoised in the layers that `layers` names; the first of these comes first.
/// With the layers of Aov::denoising it is the finished picture, bit for bit; they are left out, all others
/// stay. Empty where `progress` cancelled. Runs in the caller's arena. Throws what samples_of(),
/// Denoiser::filter() and put_before() throw, and InputError, without the file's name, for a background that
/// the colours already contain.
std::optional<Picture> denoise_picture(Picture picture, const std::vector<LayersToDenoise>& layers,
                                       Denoiser& denoiser, const DenoisePictureOptions& options,
                                       const DenoiseProgress& progress = {});

/// How an EXR of this file is written so that all but the denoised colours stays as it is.
EditedExr edited_exr(const std::filesystem::path& file, const Picture& denoised,
                     const std::vector<LayersToDenoise>& layers);

}  // namespace gatelight::renderer
