#pragma once
// Path vertices as training records: the light that each reflects towards its predecessor.

#include <tbb/enumerable_thread_specific.h>

#include "renderer/cache/cache_state.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/cache/record_batch.h"

namespace gatelight::renderer {

class RadianceRecords : public RecordSource {
 public:
  /// The references must outlive it.
  RadianceRecords(const CachedPaths& paths, const TrainingPoints& points, const RenderOptions& options,
                  const PointInputs& inputs);

  RecordRequest request(const CacheSetup& setup, std::uint64_t step, std::uint64_t records) const override;
  AnswerUnits units(const CacheSetup& setup) const override { return {1.0f / setup.target_scale}; }
  std::size_t outputs() const override { return 3; }
  const PointInputs& inputs() const override { return inputs_; }
  void trace(const RecordRequest& request, RecordBatch& batch) override;
  void finish(const AnswerPoints& answer, RecordBatch& batch) override;
  RayCounts rays() const override;

 private:
  void end_samples(const AnswerPoints& answer, RecordBatch& batch) const;

  const CachedPaths& paths_;
  const TrainingPoints& points_;
  const RenderOptions& options_;
  PointInputs inputs_;
  bool guides_ = false;  ///< samples of the picture write the cache's own radiance (PathPlan::guides)
  struct Worker {
    CachedPaths::Scratch scratch;
    RayCounts rays;
  };
  tbb::enumerable_thread_specific<Worker> workers_;
  RayCounts start_rays_;
};

}  // namespace gatelight::renderer
