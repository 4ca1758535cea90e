#pragma once
// Options that are chosen by some thousand light paths of the picture: the integrator, and whether rays may
// slip between triangles.

#include "renderer/film/camera.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// Means over the paths.
struct PilotPaths {
  double bounces = 0.0;  ///< rays after the camera's, without those between events in a medium
  double walk = 0.0;     ///< rays between events in a medium
  double light = 0.0;    ///< luminance of the paths that meet a surface; 0 if none does
  /// Luminance of white surfaces at the primary hits if nothing cast a shadow.
  double unshadowed = 0.0;
};

/// Depends on nothing but its arguments, so that every run makes the same choice. Runs in the caller's arena.
PilotPaths trace_pilot_paths(const World& world, const Camera& camera, const PixelRect& region,
                             const RenderOptions& options);

/// Number of bounces from which a picture with a cache has less error than one of paths in the same time
/// (renderer/cache/README.md), if none of them walks through media: both trace these rays.
inline constexpr double kBouncesForCache = 1.6;

/// How many times as bright as the picture the light behind walls may be where rays may slip through
/// (renderer/surface/README.md).
inline constexpr double kLightBehindWalls = 64.0;

/// The options with what suits such paths in place of RenderOptions::choose_integrator and
/// Watertight::automatic. A cache that is loaded or kept is used.
RenderOptions with_choices(RenderOptions options, const PilotPaths& paths);

}  // namespace gatelight::renderer
