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
/// row. So merge and crop treat them as all other layers.
void add_denoising_layers(Picture& picture, const NoisyPicture& samples, int factor);

bool is_denoising_layer(const std::string& name);

/// The samples of a picture.
struct Samples {
  int factor = 1;  ///< their size over that of the picture
  int width = 0;
  int height = 0;
  std::vector<float> color, albedo, normal;  ///< 3 floats a pixel; without guides the last two are empty
  std::vector<float> alpha;                  ///< 1 float a pixel; empty without one

  /// The samples must outlive it.
  NoisyPicture noisy() const;
};

/// Names of layers in files of other programs; empty: the usual ones.
struct LayerNames {
  std::string color;
  std::string albedo;
  std::string normal;
};

/// Reads the layers of add_denoising_layers(), or where there are none, those that other renderers write for
/// a denoiser: colour "Noisy Image" (Blender), "raw", "Combined" or the beauty; albedo "Denoising Albedo" or
/// "albedo"; normal "Denoising Normal", "normal" or "N". Case and all before the last dot are ignored. Values
/// that are not finite become 0. Throws InputError, without the file's name, for a named layer that is
/// missing, one without three channels, and one guide without the other.
Samples samples_of(const Picture& picture, const LayerNames& names = {});

}  // namespace gatelight::renderer
