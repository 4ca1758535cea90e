#pragma once
// Chooses the layers of a picture that are denoised, and their guides, by their names.

#include <optional>
#include <string>
#include <vector>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Layers that belong together, by their names in the picture.
struct LayersToDenoise {
  bool own = false;    ///< the samples are the layers of add_denoising_layers(); `color` is not used
  std::string color;   ///< the colours with noise
  std::string result;  ///< the layer whose colours become the denoised ones
  std::optional<std::string> albedo, normal;
  std::optional<std::string> depth, object, motion;  ///< for frames of an animation

  bool has_guides() const { return albedo || normal; }
};

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
