#pragma once
// Traces paths before training, to find out which sides of which instances light and camera reach, how bright
// the scene is, and how wide a pixel is on its surfaces.

#include <memory>

#include "renderer/cache/cache_state.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/cache/training_points.h"
#include "renderer/film/rank_tiles.h"

namespace gatelight::renderer {

struct Scouted;

struct ScoutReport {
  CacheSetup setup;
  RayCounts rays;
};

/// Gives the same bits for any number of threads and of ranks, which share the paths. For ambient occlusion
/// only primary hits are used.
class Scouting {
 public:
  Scouting();
  ~Scouting();

  /// Scouts one view. The scene of all views is the same, at any time.
  void add(const World& world, const Camera& camera, const PixelRect& region, const RenderOptions& options,
           const RankTiles* ranks = nullptr);
  /// Of all views. The rays are those of this rank.
  ScoutReport report(const scene::Scene& scene, const RenderOptions& options) const;

 private:
  std::unique_ptr<Scouted> found_;
};

}  // namespace gatelight::renderer
