#pragma once
// The soft sky of an animation.

#include <functional>
#include <vector>

#include "renderer/render.h"

namespace gatelight::apps {

/// Makes one choice for all frames (Renderer::keep_soft_sky()): no sky where what glows shows the surfaces in
/// one of these. `show` shows the renderer a frame; where the view decides, it is called and the caller has
/// to show the next frame again.
void choose_sky_of_film(renderer::Renderer& renderer, const std::vector<int>& frames,
                        const std::function<void(int frame)>& show);

}  // namespace gatelight::apps
