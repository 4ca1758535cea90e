#pragma once
// Smooth edges of what the camera sees itself: lamps and the environment.

#include <vector>

#include "renderer/film/camera.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/image/shared_rows.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// FirstHit::seen of pixels at the edges of bright light, from more points of the pixel filter than the
/// picture has samples. `seen`: what the samples found, 3 floats for each pixel of `rect`, of which `spp`
/// each; it is replaced in `rows`, of which `rect` shows those at hand, where it differs much from the pixels
/// around. Three rays a pixel of the picture at most, and no shading. Runs in the caller's arena; the same
/// bits for any number of threads.
void smooth_edges(const World& world, const Camera& camera, const FilterSampler& filter,
                  const RenderOptions& options, const PixelRect& rect, const SharedRows& rows, double spp,
                  std::vector<float>& seen);

}  // namespace gatelight::renderer
