#pragma once
// Shadows on an object that is not there itself: it catches them for a picture with an alpha.

#include <vector>

#include "renderer/film/camera.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// The alpha of black that shadows put before the background, for each pixel of `rect`: the share of the
/// pixel in which the camera sees a catcher, times 1 less what direct light reaches it of that without any
/// objects (matte, whatever its material). From `samples` points of each pixel that sees one. Runs in the
/// caller's arena; the same bits for any number of threads.
std::vector<float> catch_shadows(const World& world, const Camera& camera, const FilterSampler& filter,
                                 const RenderOptions& options, const PixelRect& rect, int samples);

}  // namespace gatelight::renderer
