#pragma once
// How long the rest of a sweep takes, from what its parts have taken so far.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/plan.h"

namespace gatelight::apps {

/// A part of the work: a run, or a reference.
struct SweepTask {
  /// Tasks of one kind take time in proportion to their work. The narrowest first; the wider ones are for a
  /// first guess.
  std::vector<std::string> kinds;
  double work = 1.0;
};

class SweepClock {
 public:
  /// Replaces all that is not done. Tasks are done in order.
  void plan_rest(const std::vector<SweepTask>& tasks);
  std::size_t done() const { return done_; }
  std::size_t count() const { return tasks_.size(); }
  void finish(double seconds);

  /// Seconds from now; `elapsed` and `fraction` are of the task under way. Nothing as long as a task is left
  /// of which no kind was finished: no guess is better than a wrong one. (fraction > 0 tells the rest
  /// of the task under way itself.)
  std::optional<double> left(double elapsed, double fraction) const;

 private:
  struct Sum {
    double work = 0.0;
    double seconds = 0.0;
  };

  std::optional<double> expected(const SweepTask& task) const;

  std::vector<SweepTask> tasks_;
  std::size_t done_ = 0;
  std::map<std::string, Sum> sums_;  ///< of the tasks that are done, by kind
};

SweepTask run_task(const PlannedScene& scene, const PlannedSeries& series, const std::vector<int>& points);
/// Of a view with these options; spp: of both halves together.
SweepTask reference_task(const PlannedScene& scene, const renderer::RenderOptions& cell, ReferenceKind kind,
                         int spp);
/// All of a scene's, before it is known which are done.
std::vector<SweepTask> all_tasks(const PlannedScene& scene, const SweepPlan& plan, int reference_spp);

}  // namespace gatelight::apps
