#pragma once
// Finds the names at the first hits of the camera rays: the layers of options.cryptomattes.

#include "renderer/film/camera.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// Points of each pixel: those of the picture's first samples, so that masks have the edges of the picture.
inline constexpr int kCryptomattePoints = 32;

/// For each pixel of `rect` the names at the first hits of its points, with their shares of the points.
/// Blended surfaces are passed at random as in the picture. Mirrors, panes and glass count as objects. The
/// background and shadow catchers have no name. Unnamed nodes and materials are "node N" and "material N", by
/// their numbers in the scene. Runs in the caller's arena; the same bits for any number of threads, and for a
/// part of the picture.
Cryptomattes trace_cryptomattes(const World& world, const Camera& camera, const FilterSampler& filter,
                                const RenderOptions& options, const PixelRect& rect);

}  // namespace gatelight::renderer
