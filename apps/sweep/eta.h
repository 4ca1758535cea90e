#pragma once
// Estimates the remaining time of a sweep from the times of its finished tasks.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/plan.h"

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

}  // namespace gatelight::apps
