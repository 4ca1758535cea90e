#pragma once
// How long the rest of a sweep takes, from what its parts have taken so far.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace gatelight::apps
