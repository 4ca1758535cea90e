#pragma once
// A pass adds samples to every pixel. It is the render loop's interface to an integrator.

#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>

#include "base/parallel/loops.h"
#include "renderer/film/film.h"
#include "renderer/film/film_samples.h"
#include "renderer/film/tiles.h"
#include "renderer/settings/statistics.h"

namespace gatelight::renderer {

/// The inputs of a pass. All members outlive it.
struct PassContext {
  const TileGrid& tiles;
  const RenderOptions& options;
  const Camera& camera;
  const FilterSampler& filter;
};

class Pass {
 public:
  virtual ~Pass() = default;
  /// Adds `samples` samples of each pixel to the film, in order. Runs in the caller's arena. Calls
  /// report(fraction done) from any thread.
  virtual void run(int samples, Film& film, const std::function<void(double)>& report) = 0;
  /// From this time on run() leaves out the pixels that are not begun yet.
  void end_at(std::chrono::steady_clock::time_point end) { end_ = end; }
  /// Whether a run left pixels out.
  bool cut_short() const { return cut_short_; }
  /// Sums over all runs so far.
  virtual SampleCounts counts() const = 0;
  virtual RayCounts rays() const = 0;
  /// Adds the cache statistics of all runs; a pass without a cache adds nothing.
  virtual void add_to(CacheStatistics&) const {}

 protected:
  /// Whether the remaining pixels are left out.
  bool out_of_time() {
    if (end_ == std::chrono::steady_clock::time_point::max() || std::chrono::steady_clock::now() < end_)
      return false;
    return cut_short_ = true;
  }

 private:
  std::chrono::steady_clock::time_point end_ = std::chrono::steady_clock::time_point::max();
  std::atomic<bool> cut_short_ = false;
};

/// A pass with one Worker for each thread. Worker has the members `RayCounts rays` and `SampleCounts counts`.
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
  /// Calls body(worker, tile) for the number of each tile, but for those that time leaves out.
  template <class Body>
  void each_tile(const TileGrid& tiles, const std::function<void(double)>& report, const Body& body) {
    std::atomic<int> done = 0;
    for_each(static_cast<std::size_t>(tiles.count()), [&](std::size_t tile) {
      if (out_of_time()) return;
      body(workers_.local(), static_cast<int>(tile));
      report(static_cast<double>(++done) / tiles.count());
    });
  }

  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace gatelight::renderer
