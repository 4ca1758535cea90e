#pragma once
// Passes of the integrators with a cache. A thread traces a tile up to its queries, answers them and finishes
// the tile. A separate device needs many points at once: there many tiles are traced, answered together, and
// finished.

#include <functional>
#include <span>
#include <vector>

#include "renderer/cache/cache_session.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/transport/ao_integrator.h"
#include "renderer/transport/pass.h"

namespace gatelight::renderer {

/// A tile between its tracing and its answers.
struct CachedTile {
  std::vector<Pixel> pixels;
  std::vector<PixelSample> taken;
  std::vector<CameraSample> samples;
  std::vector<PathStart> starts;
  std::vector<SampleResult> results;
  std::vector<FirstHit> first_hits;
  std::vector<Color> radiance;
  PathBatch paths;
  std::span<const float> answers;  ///< of paths.queries
};

struct CachedWorker {
  CachedPaths::Scratch scratch;
  AoIntegrator::Scratch occlusion;
  PathBatch check;  ///< for the layer cache-error
  CachedTile tile;
  std::vector<float> answers;  ///< of the tile
  CacheStatistics statistics;  ///< of its tiles
  RayCounts rays;
  SampleCounts counts;
};

class CachedPass : public WorkerPass<CachedWorker> {
 public:
  /// options.integrator is nao or nrc. The session must outlive the pass, which uses it exclusively.
  CachedPass(const World& world, const PassContext& context, CacheSession& session);

  void add_to(CacheStatistics& statistics) const override;

  void run(int samples, Film& film, const std::function<void(double)>& report) override;

 private:
  using Tile = CachedTile;

  void run_tiles(int samples, Film& film, const std::function<void(double)>& report);
  void run_batches(int samples, Film& film, const std::function<void(double)>& report);
  /// Traces the next sample of the tile's pixels up to its queries.
  void begin(Tile& tile, Film& film, CachedWorker& worker) const;
  /// Adds the sample, with its answers, to the film.
  void finish(Tile& tile, Film& film, CachedWorker& worker) const;
  void trace_paths(Tile& tile, CachedWorker& worker) const;
  void trace_occlusion(Tile& tile, CachedWorker& worker) const;
  void finish_paths(Tile& tile) const;
  void finish_occlusion(Tile& tile) const;
  std::vector<std::int32_t> check_records(const Tile& tile, CachedWorker& worker) const;
  void describe_answers(Tile& tile, CachedWorker& worker) const;

  const World& world_;
  PassContext context_;
  CacheSession& session_;
  StoredSurfaces stored_;
  CachedPaths paths_;
  PathPlan plan_;
  AoIntegrator ao_;
  bool needs_error_;
  CacheStatistics statistics_;  ///< beside those of the workers
  // Of a device.
  std::vector<Tile> tiles_;
  std::vector<std::size_t> offsets_;  ///< of the tiles' queries
  SurfacePoints queries_;
  std::vector<float> answers_;
};

}  // namespace gatelight::renderer
