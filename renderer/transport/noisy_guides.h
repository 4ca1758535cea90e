#pragma once
// Where albedo and normal, which guide the denoiser, have noise of their own.

#include "renderer/film/camera.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// The part of the region with all pixels whose samples may have different guide surfaces for a reason other
/// than an edge: mirrors and clear glass, which reflect and transmit at random, and surfaces with alpha. With
/// a lens, an open shutter or fog it is the region; without such pixels it is empty. Traces one ray for every
/// four pixels. Runs in the caller's arena.
PixelRect noisy_guides(const World& world, const Camera& camera, const PixelRect& region,
                       const RenderOptions& options);

}  // namespace gatelight::renderer
