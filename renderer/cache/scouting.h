#pragma once
// A look at the scene before anything is learned: paths are traced and thrown away. They tell which sides of
// which instances light and eyes meet, how bright it is, and how far it reaches.

#include "renderer/cache/cache_state.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/cache/training_points.h"

namespace gatelight::renderer {

struct ScoutReport {
  CacheSetup setup;
  RayCounts rays;
};

/// Reads the picture's region and options; the same bits for any number of threads. For ambient occlusion
/// only primary hits are looked at.
ScoutReport scout(const World& world, const Camera& camera, const PixelRect& region,
                  const RenderOptions& options);

}  // namespace gatelight::renderer
