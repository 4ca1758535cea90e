#pragma once
// Traces paths before training, to find out which sides of which instances light and camera reach, how bright
// the scene is, and how wide a pixel is on its surfaces.

#include "renderer/cache/cache_state.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/cache/training_points.h"

namespace gatelight::renderer {

struct ScoutReport {
  CacheSetup setup;
  RayCounts rays;
};

/// Gives the same bits for any number of threads. For ambient occlusion only primary hits are used.
ScoutReport scout(const World& world, const Camera& camera, const PixelRect& region,
                  const RenderOptions& options);

}  // namespace gatelight::renderer
