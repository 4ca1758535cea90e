#pragma once
// Progress of a sweep on stderr: a bar over all tasks, JSON lines, or a line for each task.

#include <string>

#include "apps/sweep/eta.h"
#include "apps/terminal/progress.h"
#include "base/clock.h"

namespace gatelight::apps {

/// Thread-safe.
class SweepProgress : public ProgressLine {
 public:
  /// quiet: no output, in every mode.
  SweepProgress(ProgressMode mode, bool quiet);

  /// Sets the remaining tasks, in order.
  void plan_rest(const std::vector<SweepTask>& tasks);
  /// Shows a phase other than rendering: loading, building, measuring.
  void phase(const std::string& what, double fraction = 0.0);
  /// one_piece: the fraction in updates is that of the whole task, not of a phase.
  void begin(const std::string& task, bool one_piece);
  void update(const renderer::Progress& progress);
  /// A cell of the task is done or failed.
  void cell(const std::string& id, const std::string& status);
  void end();
  void done(const std::string& folder, std::size_t cells, std::size_t failed);

 private:
  void show(const std::string& what, double fraction, bool must);

  bool words_;  ///< a line for each task
  SweepClock clock_;
  std::string task_;
  bool one_piece_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point task_start_ = start_;
  int cells_ = 0;  ///< of the task
};

}  // namespace gatelight::apps
