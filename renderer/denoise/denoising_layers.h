#pragma once
// Writes and reads a denoiser's inputs as layers of a picture.

#include <optional>
#include <string>
#include <vector>

#include "renderer/denoise/denoise.h"
#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Appends the layers of Aov::denoising: denoising-color, -albedo, -normal and, where there is one, -alpha,
/// in full precision. Where the samples are of `factor` times the picture's size, each pixel of the picture
/// has factor x factor of theirs, and each of these has its own layers, with the suffix -XY: its column and
/// row. So merge and crop treat them as all other layers. Metadata keep NoisyPicture::noisy_guides.
void add_denoising_layers(Picture& picture, const NoisyPicture& samples, int factor);

bool is_denoising_layer(const std::string& name);

/// Layers that belong together, by their names in the picture.
struct LayersToDenoise {
  bool own = false;    ///< the samples are the layers of add_denoising_layers(); `color` is not used
  std::string color;   ///< the colours with noise
  std::string result;  ///< the layer whose colours become the denoised ones
  std::optional<std::string> albedo, normal;

  bool has_guides() const { return albedo || normal; }
};

/// The samples of a picture.
struct Samples {
  int factor = 1;  ///< their size over that of the picture
  int width = 0;
  int height = 0;
  std::vector<float> color, albedo, normal;  ///< 3 floats a pixel; without guides the last two are empty
  std::vector<float> alpha;                  ///< 1 float a pixel; empty without one
  std::optional<PixelRect> noisy_guides;     ///< NoisyPicture::noisy_guides

  /// The samples must outlive it.
  NoisyPicture noisy() const;
};

/// Whether the picture has the layers of add_denoising_layers().
bool has_denoising_layers(const Picture& picture);

/// These layers. The beauty becomes the denoised picture.
LayersToDenoise own_layers(const Picture& picture);

/// Reads layers that are chosen. Values that are not finite become 0. In place of a single guide that is
/// missing stands a white albedo, or a normal that is the same everywhere. Throws InputError, without the
/// file's name, for a layer of add_denoising_layers() that is missing or has other channels.
Samples samples_of(const Picture& picture, const LayersToDenoise& layers);

}  // namespace gatelight::renderer
