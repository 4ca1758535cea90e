#pragma once
// Progress of a sweep on stderr: a bar over all tasks, JSON lines, or a line for each task. The time left is
// estimated from the times of the tasks that are done.

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/plan.h"
#include "apps/terminal/progress.h"
#include "base/clock.h"

namespace gatelight::apps {

/// A part of the work: a run or a reference.
struct SweepTask {
  std::string kind;  ///< time is proportional to work among tasks of one kind
  double work = 1.0;
};

class SweepClock {
 public:
  /// Replaces all tasks that are not done. Tasks are done in order.
  void plan_rest(const std::vector<SweepTask>& tasks);
  std::size_t done() const { return done_; }
  std::size_t count() const { return tasks_.size(); }
  void finish(double seconds);

  /// The remaining seconds. `elapsed` and `fraction` belong to the current task; fraction > 0 is enough to
  /// estimate its rest. A kind without a finished task is as quick as those that have one. Returns nothing
  /// where there are no tasks, or none is finished.
  std::optional<double> left(double elapsed, double fraction) const;

 private:
  struct Sum {
    double work = 0.0;
    double seconds = 0.0;
  };

  std::optional<double> expected(const SweepTask& task) const;

  std::vector<SweepTask> tasks_;
  std::size_t done_ = 0;
  Sum finished_;
  std::map<std::string, Sum> finished_of_kind_;
};

SweepTask run_task(const PlannedSeries& series, const std::vector<int>& points);
/// The task of a reference with these options; spp: of both halves together.
SweepTask reference_task(const renderer::RenderOptions& cell, ReferenceKind kind, int spp);

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
  /// A JSON line about the task under way.
  nlohmann::ordered_json event(const char* name, double seconds, const std::optional<double>& left) const;

  bool words_;  ///< a line for each task
  SweepClock clock_;
  std::string task_;
  bool one_piece_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point task_start_ = start_;
  int cells_ = 0;  ///< of the task
};

}  // namespace gatelight::apps
