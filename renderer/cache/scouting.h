#pragma once
// Traces paths before training, to find out which sides of which instances light and camera reach, how bright
// the scene is, and how wide a pixel is on its surfaces.

#include <memory>

#include "renderer/cache/cache_state.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/cache/record_exchange.h"
#include "renderer/cache/training_points.h"

namespace gatelight::renderer {

struct Scouted;

struct ScoutReport {
  CacheSetup setup;
  RayCounts rays;
};

/// Gives the same bits for any number of threads. For ambient occlusion only primary hits are used.
class Scouting {
 public:
  Scouting();
  ~Scouting();

  /// Scouts one view, whose paths the processes of the exchange share. The scene of all views is the same, at
  /// any time.
  void add(const World& world, const Camera& camera, const PixelRect& region, const RenderOptions& options,
           RecordExchange exchange = {});
  /// Of all views. The rays are those that were counted here.
  ScoutReport report(const scene::Scene& scene, const RenderOptions& options) const;

 private:
  std::unique_ptr<Scouted> found_;
};

}  // namespace gatelight::renderer
