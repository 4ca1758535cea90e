#pragma once
// Passes of the integrators with a cache. Many tiles are traced up to their queries, answered together, and
// finished.

#include "renderer/cache/cache_session.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/transport/ao_integrator.h"
#include "renderer/transport/pass.h"

namespace gatelight::renderer {

struct CachedWorker {
  CachedPaths::Scratch scratch;
  AoIntegrator::Scratch occlusion;
  PathBatch check;  ///< for the layer cache-error
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
  /// A tile between its tracing and its answers.
  struct Tile {
    std::vector<Pixel> pixels;
    std::vector<PixelSample> taken;
    std::vector<CameraSample> samples;
    std::vector<PathStart> starts;
    std::vector<SampleResult> results;
    std::vector<FirstHit> first_hits;
    std::vector<Color> radiance;
    PathBatch paths;
    std::size_t first_query = 0;
  };

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
  std::vector<Tile> tiles_;
  SurfacePoints queries_;
  std::vector<float> answers_;
  CacheStatistics statistics_;
};

}  // namespace gatelight::renderer
