#pragma once
// Light that frames in files take over from the frame before.

#include <vector>

#include "renderer/denoise/denoising_layers.h"
#include "renderer/driver/denoise_picture.h"

namespace gatelight::renderer {

/// Mixes the light of the frame before into denoised colours, 3 floats a pixel, and keeps them for the next
/// frame. Larger samples than the picture's take nothing over. Runs in the caller's arena.
void mix_earlier_frame(const Picture& picture, const LayersToDenoise& layers, const Samples& samples,
                       EarlierFrame& earlier, std::vector<float>& denoised);

}  // namespace gatelight::renderer
