#pragma once
// The exposure of an animation: one for all its frames, whichever of them are rendered.

#include <functional>
#include <vector>

#include "renderer/render.h"

namespace gatelight::apps {

/// The options of the small pictures by which an animation is measured. Of a picture's options they have
/// those of its light and view; neither its size nor its seed, but its aspect ratio.
renderer::RenderOptions measuring_options(renderer::RenderOptions options);

/// One exposure in stops for frames that suit these ones: their mean, each at most two stops from their
/// median; 0 without any.
float common_exposure(std::vector<float> stops);

/// common_exposure() of the frames that are not black, where the pictures are. `renderer` has
/// measuring_options(); `show` shows it a frame.
float sequence_exposure(renderer::Renderer& renderer, const std::vector<int>& frames,
                        const std::function<void(int frame)>& show, const renderer::Callbacks& callbacks);

}  // namespace gatelight::apps
