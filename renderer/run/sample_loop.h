#pragma once
// Runs pass after pass over one film: chooses the samples of each pass, reports progress, and checks for the
// end.

#include <tbb/task_arena.h>

#include <atomic>
#include <mutex>

#include "renderer/machine/clock.h"
#include "renderer/render.h"
#include "renderer/transport/pass.h"

namespace gatelight::renderer {

class SampleLoop {
 public:
  /// `spp` is the goal that progress reports. The references must outlive the loop. Its clock starts now.
  SampleLoop(tbb::task_arena& arena, const RenderOptions& options, const Callbacks& callbacks, Pass& pass,
             Film& film, int spp);

  /// The film already holds so many samples of an earlier run.
  void begin_at(int done) { done_ = done; }
  /// Stops the loop, as callbacks.stop does.
  void stop() { stop_ = true; }

  /// Runs one pass, up to `goal` samples. Throws NumericalError under NanPolicy::error.
  void run_pass(int goal);
  /// Finished samples of every pixel.
  int done() const { return done_; }
  /// Whether the loop was stopped or the time is over.
  bool over() const;
  double seconds() const { return seconds_since(start_) - left_out_; }
  /// Excludes time that the caller spent on something else.
  void leave_out(double seconds) { left_out_ += seconds; }
  /// Reports the end as progress.
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
