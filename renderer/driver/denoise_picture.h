#pragma once
// Denoises a picture that was rendered before, by this program or another.

#include <filesystem>
#include <map>
#include <memory>
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

struct PictureHistory;

/// What a frame of an animation hands on to the next one.
struct EarlierFrame {
  std::map<std::string, std::shared_ptr<PictureHistory>> light;  ///< by the layer that is denoised
  double share = 0.0;  ///< of the last one's pixels that took light over
};

/// The picture with its samples denoised in the layers that `layers` names; the first of these comes first.
/// With the layers of Aov::denoising it is the finished picture, bit for bit; they are left out, all others
/// stay. With `earlier` the light of the frame before is mixed in where the layers tell that it still holds
/// (reuse/picture_history.h), and this frame takes its place. Empty where `progress` cancelled. Runs in the
/// caller's arena. Throws what samples_of(), Denoiser::filter() and put_before() throw, and InputError,
/// without the file's name, for a background that the colours already contain.
std::optional<Picture> denoise_picture(Picture picture, const std::vector<LayersToDenoise>& layers,
                                       Denoiser& denoiser, const DenoisePictureOptions& options,
                                       const DenoiseProgress& progress = {}, EarlierFrame* earlier = nullptr);

/// How an EXR of this file is written so that all but the denoised colours stays as it is.
EditedExr edited_exr(const std::filesystem::path& file, const Picture& denoised,
                     const std::vector<LayersToDenoise>& layers);

}  // namespace gatelight::renderer
