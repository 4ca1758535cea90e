#pragma once
// Shadows on invisible objects (shadow catchers), for a picture with an alpha.

#include <vector>

#include "renderer/film/camera.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// The alpha of the black shadow before the background, for each pixel of `rect`: the share of the pixel
/// where the camera sees a catcher, times 1 minus the ratio of its direct light to that with catchers alone.
/// Catchers are matte, whatever their material. Uses `samples` points of each pixel. Runs in the caller's
/// arena; the same bits for any number of threads.
std::vector<float> catch_shadows(const World& world, const Camera& camera, const FilterSampler& filter,
                                 const RenderOptions& options, const PixelRect& rect, int samples);

}  // namespace gatelight::renderer
