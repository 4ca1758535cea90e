#pragma once
// The statistics of a picture that is being made.

#include "base/clock.h"
#include "renderer/driver/render_context.h"
#include "renderer/driver/sample_loop.h"
#include "renderer/driver/training.h"

namespace gatelight::renderer {

/// The picture begins with the construction.
class PictureStatistics {
 public:
  explicit PictureStatistics(const RenderContext& context);

  /// Statistics of this run and of the earlier ones, of all processes, which all call it. `training`: null
  /// without a cache. `loop`: null before the first pass.
  RenderStatistics sum_up(const Film& film, const Training* training, const SampleLoop* loop) const;

  const Clock::time_point begin = Clock::now();
  RenderStatistics earlier;  ///< of the checkpoint from which the picture was resumed
  double cryptomatte_seconds = 0.0;

 private:
  void add_others(RenderStatistics& sum, const CacheSession* session) const;

  RenderContext context_;
  Traffic traffic_before_;
};

}  // namespace gatelight::renderer
