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

  RecordRequest request(const CacheSetup& setup, std::uint64_t step, std::uint64_t records,
                        bool to_the_end) const override;
  AnswerUnits units(const CacheSetup& setup) const override { return {1.0f / setup.target_scale}; }
  std::size_t outputs() const override { return 3; }
  const PointInputs& inputs() const override { return inputs_; }
  using RecordSource::trace;
  void begin(const RecordRequest& request, RecordBatch& batch) override;
  void trace(RecordBatch& batch, std::size_t block) override;
  void finish(const AnswerPoints& answer, RecordBatch& batch) override;
  RayCounts rays() const override;

 private:
  /// Sums up the paths of a block, whose queries have these answers.
  void resolve(std::span<float> answers, RecordBatch& batch, std::size_t block) const;
  /// Asks for the points of all blocks at once, and calls use(answers, block) for each. points(paths, own)
  /// returns those of a block; it may put them into `own`.
  template <class Points, class Use>
  void ask_together(const AnswerPoints& answer, RecordBatch& batch, const Points& points,
                    const Use& use) const;

  const CachedPaths& paths_;
  const TrainingPoints& points_;
  const RenderOptions& options_;
  PointInputs inputs_;
  bool guides_ = false;     ///< samples of the picture write the cache's own radiance (PathPlan::guides)
  std::size_t passes_ = 0;  ///< number of render passes
  struct Worker {
    CachedPaths::Scratch scratch;
    RayCounts rays;
  };
  tbb::enumerable_thread_specific<Worker> workers_;
  RayCounts start_rays_;
};

}  // namespace gatelight::renderer
