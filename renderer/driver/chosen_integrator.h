#pragma once
// Decides whether a cache pays off in a scene.

#include "renderer/film/camera.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// Mean number of rays after the camera's of light paths of the picture, from some thousand of them. A cache
/// replaces most of them, but none between events in a medium, which do not count. It depends on nothing
/// else, so that every run makes the same choice. Runs in the caller's arena.
double bounces_of_paths(const World& world, const Camera& camera, const PixelRect& region,
                        const RenderOptions& options);

/// Number of bounces of paths from which a picture with a cache has less error than one of paths in the same
/// time (renderer/cache/README.md).
inline constexpr double kBouncesForCache = 1.6;

/// The options with the integrator that suits such paths, for RenderOptions::choose_integrator. A cache that
/// is loaded or kept is used.
RenderOptions with_integrator(RenderOptions options, double bounces);

}  // namespace gatelight::renderer
