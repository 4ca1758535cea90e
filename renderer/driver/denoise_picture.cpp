#include "renderer/driver/denoise_picture.h"

#include <utility>
#include <vector>

#include "renderer/denoise/denoise.h"
#include "renderer/driver/background.h"
#include "renderer/image/color_channels.h"

namespace gatelight::renderer {
namespace {

/// Replaces the colours of a layer that may have an alpha.
void set_colors(Layer& layer, const std::vector<float>& color) {
  const std::size_t channels = layer.channels.size();
  const auto index = color_channels(layer);
  for (std::size_t p = 0; index && p < color.size() / 3; ++p) {
    for (std::size_t c = 0; c < 3; ++c) layer.values[p * channels + (*index)[c]] = color[3 * p + c];
  }
}

}  // namespace

std::optional<Picture> denoise_picture(Picture picture, const Samples& samples, Denoiser& denoiser,
                                       const DenoisePictureOptions& options,
                                       const DenoiseProgress& progress) {
  const ScaleDown scale(samples.factor, options.filter, options.filter_width);
  auto denoised = denoise(denoiser, samples.noisy(), {.prefilter = options.prefilter}, scale, progress);
  if (!denoised) return std::nullopt;
  std::erase_if(picture.layers, [](const Layer& layer) { return is_denoising_layer(layer.name); });
  if (samples.alpha.empty()) {
    // An alpha of another program stays.
    set_colors(picture.layers.front(), denoised->color);
  } else {
    picture.layers.front() = {.channels = {"R", "G", "B"}, .values = std::move(denoised->color)};
    put_before(picture, denoised->alpha, options.background);
  }
  return picture;
}

}  // namespace gatelight::renderer
