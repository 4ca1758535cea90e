#pragma once
// Pass after pass over one film: how many samples each takes, and what is told and asked meanwhile.

#include <tbb/task_arena.h>

#include <atomic>
#include <mutex>

#include "renderer/machine/clock.h"
#include "renderer/render.h"
#include "renderer/transport/pass.h"

namespace gatelight::renderer {

class SampleLoop {
 public:
  /// `spp` is what progress counts up to. All but it outlive the loop, whose clock starts now.
  SampleLoop(tbb::task_arena& arena, const RenderOptions& options, const Callbacks& callbacks, Pass& pass,
             Film& film, int spp);

  /// The film holds so many samples of an earlier run.
  void begin_at(int done) { done_ = done; }
  /// As callbacks.stop does.
  void stop() { stop_ = true; }

  /// One pass, to `goal` samples at most. Throws NumericalError under NanPolicy::error.
  void run_pass(int goal);
  /// Samples of every pixel.
  int done() const { return done_; }
  /// Stopped, or out of time.
  bool over() const;
  double seconds() const { return seconds_since(start_) - left_out_; }
  /// Time that the caller has spent on something else.
  void leave_out(double seconds) { left_out_ += seconds; }
  /// Tells that it has ended.
  void report_end() const;

 private:
  void report(double of_pass, int batch);

  tbb::task_arena& arena_;
  const RenderOptions& options_;
  const Callbacks& callbacks_;
  Pass& pass_;
  Film& film_;
  int spp_;
  int done_ = 0;
  int batch_ = 1;  ///< samples of the next pass
  std::atomic<bool> stop_ = false;
  Clock::time_point start_ = Clock::now();
  double left_out_ = 0.0;
  double last_seconds_ = 0.0;  ///< when the last pass ended
  std::mutex report_mutex_;
  double last_report_ = -1.0;
};

}  // namespace gatelight::renderer
