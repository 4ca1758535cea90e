#include "renderer/driver/denoise_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "renderer/denoise/denoise.h"
#include "renderer/denoise/denoising_layers.h"
#include "renderer/driver/background.h"
#include "renderer/image/color_channels.h"

namespace gatelight::renderer {
namespace {

/// Replaces the colours of a layer; a grey one gets their mean. Its other channels stay.
void set_colors(Layer& layer, const std::vector<float>& color) {
  const std::size_t channels = layer.channels.size();
  const auto index = color_channels(layer).value();
  const bool grey = index[0] == index[1];
  for (std::size_t p = 0; p < color.size() / 3; ++p) {
    const float* const c = &color[3 * p];
    for (std::size_t k = 0; k < 3; ++k)
      layer.values[p * channels + index[k]] = grey ? (c[0] + c[1] + c[2]) / 3.0f : c[k];
  }
}

/// The colours already contain the background, with sharp edges of the objects in front of it.
void require_alpha(const Samples& samples, const BackgroundOptions& background) {
  using Kind = BackgroundOptions::Kind;
  if (background.is_separate() && background.kind != Kind::transparent && samples.alpha.empty())
    throw InputError(
        "has no samples of its alpha, expected the layers of --aov denoising for a picture with a separate "
        "background");
}

void put_first(Picture& picture, const std::string& name) {
  const auto found = std::find_if(picture.layers.begin(), picture.layers.end(),
                                  [&](const Layer& layer) { return layer.name == name; });
  std::rotate(picture.layers.begin(), found, found + 1);
}

}  // namespace

std::optional<Picture> denoise_picture(Picture picture, const std::vector<LayersToDenoise>& layers,
                                       Denoiser& denoiser, const DenoisePictureOptions& options,
                                       const DenoiseProgress& progress) {
  // All samples are read before any of their layers is replaced.
  std::vector<Samples> samples;
  for (const LayersToDenoise& some : layers) {
    samples.push_back(samples_of(picture, some));
    require_alpha(samples.back(), options.background);
  }
  std::erase_if(picture.layers, [](const Layer& layer) { return is_denoising_layer(layer.name); });
  for (std::size_t i = layers.size(); i-- > 0;) {
    const auto part = [&, done = static_cast<double>(layers.size() - 1 - i)](double of_part) {
      return !progress || progress((done + of_part) / static_cast<double>(layers.size()));
    };
    const ScaleDown scale(samples[i].factor, options.filter, options.filter_width);
    auto denoised = denoise(denoiser, samples[i].noisy(), {.prefilter = options.prefilter}, scale, part);
    if (!denoised) return std::nullopt;
    put_first(picture, layers[i].result);
    if (samples[i].alpha.empty()) {
      // An alpha of another program stays.
      set_colors(picture.layers.front(), denoised->color);
    } else {
      Layer& beauty = picture.layers.front();
      beauty = {.name = beauty.name, .channels = {"R", "G", "B"}, .values = std::move(denoised->color)};
      put_before(picture, denoised->alpha, options.background);
    }
  }
  return picture;
}

EditedExr edited_exr(const std::filesystem::path& file, const Picture& denoised,
                     const std::vector<LayersToDenoise>& layers) {
  EditedExr edited{.file = file};
  for (const LayersToDenoise& some : layers) {
    const Layer& result = *denoised.find(some.result);
    std::vector<std::string>& channels = edited.channels[some.result];
    if (some.own) channels = result.channels;
    const auto colors = color_channels(result).value();  // a temporary ends before the loop
    for (const std::size_t index : colors) channels.push_back(result.channels[index]);
  }
  return edited;
}

}  // namespace gatelight::renderer
