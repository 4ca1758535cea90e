#pragma once
// Chooses the layers of a picture that are denoised, and their guides, by their names.

#include <string>
#include <vector>

#include "renderer/denoise/denoising_layers.h"
#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Names of layers; empty: the usual ones. For a guide "none": there is none.
struct LayerNames {
  std::string color;
  std::string albedo;
  std::string normal;
};

/// Layers in files of other programs are found by their names, in any case (layer_names.h). A view layer is
/// all layers with the same name before the last dot. Of several, each is denoised that has colours and a
/// guide; where none has a guide, only that which is shown, with guides of any name. The colours are
/// "Noisy Image" (Blender), "raw" (ours), or the beauty, and the beauty becomes the denoised picture. A layer
/// of colours that is named is also the one that is replaced. Of several view layers, a guide that is named
/// is that of its own. Guides whose channels do not suit are left out. Throws InputError, without the file's
/// name, for a named layer that is missing or has other channels, and for a picture without colours.
std::vector<LayersToDenoise> layers_to_denoise(const Picture& picture, const LayerNames& names = {});

/// The other layers whose name says that they hold a picture's colours, and which stay as they are.
std::vector<std::string> colors_left(const Picture& picture, const std::vector<LayersToDenoise>& chosen);

}  // namespace gatelight::renderer
