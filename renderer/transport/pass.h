#pragma once
// A pass adds some samples to every pixel: what the render loop knows of an integrator.

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <functional>

#include "renderer/film/film.h"
#include "renderer/film/film_samples.h"
#include "renderer/film/tiles.h"
#include "renderer/settings/statistics.h"

namespace gatelight::renderer {

/// What a pass belongs to. All outlive it.
struct PassContext {
  const TileGrid& tiles;
  const RenderOptions& options;
  const Camera& camera;
  const FilterSampler& filter;
};

class Pass {
 public:
  virtual ~Pass() = default;
  /// Adds the samples first <= s < end to the film, in order for each pixel. Runs in the caller's arena;
  /// `report` is told the fraction done, from any thread.
  virtual void run(std::uint32_t first, std::uint32_t end, Film& film,
                   const std::function<void(double)>& report) = 0;
  /// Of all runs so far.
  virtual SampleCounts counts() const = 0;
  virtual RayCounts rays() const = 0;
  /// Adds what all runs asked of a cache; a pass without a cache adds nothing.
  virtual void add_to(CacheStatistics&) const {}
};

/// A pass whose threads each have a Worker, with `RayCounts rays` and `SampleCounts counts` among its
/// members.
template <class Worker>
class WorkerPass : public Pass {
 public:
  SampleCounts counts() const final {
    SampleCounts sum;
    for (const Worker& w : workers_) sum.add(w.counts);
    keep_first(sum.located);
    return sum;
  }
  RayCounts rays() const final {
    RayCounts sum;
    for (const Worker& w : workers_) sum.add(w.rays);
    return sum;
  }

 protected:
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace gatelight::renderer
