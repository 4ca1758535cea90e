#pragma once
// Runs pass after pass over one film: chooses the samples of each pass, reports progress, and checks for the
// end. Each process of the team has its own tiles, and all run the same passes.

#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "renderer/driver/render_context.h"
#include "renderer/driver/training.h"
#include "renderer/transport/pass.h"

namespace gatelight::renderer {

class SampleLoop {
 public:
  /// Its clock starts now. `training`: null without a cache. `spp` is the goal that progress reports. Film
  /// and training must outlive the loop.
  SampleLoop(const RenderContext& context, Film& film, Training* training, int spp);

  /// The film already has `done` samples per pixel, of an earlier run.
  void begin_at(int done) { done_ = done; }
  /// Stops the loop, as callbacks.stop does.
  void stop() { stop_ = true; }

  /// The time at which passes should end. `in_part`: the last pass may then leave pixels out.
  void end_at(Clock::time_point end, bool in_part);
  /// The last estimate of the error, and the samples at which the picture is expected to end by it.
  void report_error(double error, double samples);

  const Pass& pass() const { return *pass_; }
  /// Runs one pass, up to `goal` samples. Throws NumericalError under NanPolicy::error.
  void run_pass(int goal);
  /// The work of each process in the last pass.
  const std::vector<RankWork>& last_pass() const { return last_pass_; }
  /// Finished samples of every pixel.
  int done() const { return done_; }
  /// Whether the loop was stopped or the time is over, at any process.
  bool over() const;
  bool stopped() const { return stop_; }
  double seconds() const { return seconds_since(start_) - left_out_; }
  /// Excludes time that the caller spent on something else.
  void leave_out(double seconds) { left_out_ += seconds; }
  /// Reports the end as progress.
  void report_end() const;

 private:
  /// The report that a process sends to the others after a pass.
  struct PassReport {
    RankWork work;
    bool stop = false;
    bool cut_short = false;
    NonFiniteSample nonfinite;
    bool found_nonfinite = false;
  };
  /// Joins the reports of all.
  void note_pass(int batch, double seconds);
  void report(double of_pass, int batch);
  Progress progress(double samples) const;
  double now() const { return seconds_since(start_); }

  const PreparedPicture& picture_;
  const Callbacks& callbacks_;
  const PictureTeam& team_;
  Film& film_;
  std::unique_ptr<Pass> pass_;
  int spp_;
  int done_ = 0;
  int batch_ = 1;  ///< samples of the next pass
  std::atomic<bool> stop_ = false;
  Clock::time_point start_ = Clock::now();
  double left_out_ = 0.0;
  double end_ = std::numeric_limits<double>::infinity();  ///< of the passes, in seconds since the start
  bool in_part_ = false;
  double per_sample_ = 0.0;  ///< seconds of the last pass
  bool cut_short_ = false;   ///< pixels were left out, at any process
  std::uint64_t rays_ = 0;   ///< of this process, before the last pass
  std::vector<RankWork> last_pass_;
  std::optional<double> error_;
  double expected_samples_ = 0.0;  ///< by the error
  std::mutex report_mutex_;
  double last_report_ = -1.0;
};

}  // namespace gatelight::renderer
