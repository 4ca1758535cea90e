#pragma once
// Records of ambient occlusion at training points: the estimate of AoIntegrator, with one or more rays per
// point.

#include <tbb/enumerable_thread_specific.h>

#include "renderer/cache/cache_state.h"
#include "renderer/cache/record_batch.h"
#include "renderer/transport/ao_integrator.h"

namespace gatelight::renderer {

class OcclusionRecords : public RecordSource {
 public:
  /// The references must outlive it. distance: metres, may be infinite.
  OcclusionRecords(const World& world, const TrainingPoints& points, const RenderOptions& options,
                   const StoredSurfaces& stored, float distance, const PointInputs& inputs);

  RecordRequest request(const CacheSetup& setup, std::uint64_t step, std::uint64_t records,
                        bool /*to_the_end*/) const override {
    return {.step = step,
            .points = points_for(static_cast<double>(records), static_cast<double>(setup.records_per_path))};
  }
  AnswerUnits units(const CacheSetup&) const override { return {.greatest = 1.0f}; }
  std::size_t outputs() const override { return 1; }
  const PointInputs& inputs() const override { return inputs_; }
  using RecordSource::trace;
  void begin(const RecordRequest& request, RecordBatch& batch) override;
  void trace(RecordBatch& batch, std::size_t block) override;
  void finish(const AnswerPoints&, RecordBatch&) override {}
  RayCounts rays() const override;

 private:
  const World& world_;
  const TrainingPoints& points_;
  const RenderOptions& options_;
  const StoredSurfaces& stored_;
  float distance_;
  PointInputs inputs_;
  bool needs_hits_ = false;  ///< the starts that were begun last have no hits yet
  RayCounts start_rays_;
  tbb::enumerable_thread_specific<RayCounts> counts_;
};

}  // namespace gatelight::renderer
