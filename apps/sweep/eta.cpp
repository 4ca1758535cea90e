#include "apps/sweep/eta.h"

#include <algorithm>

namespace gatelight::apps {

void SweepClock::plan_rest(const std::vector<SweepTask>& tasks) {
  tasks_.resize(done_);
  tasks_.insert(tasks_.end(), tasks.begin(), tasks.end());
}

void SweepClock::finish(double seconds) {
  seconds_.push_back(seconds);
  ++done_;
}

std::optional<double> SweepClock::rate(std::string SweepTask::*kind, const std::string& name) const {
  double work = 0.0;
  double seconds = 0.0;
  for (std::size_t i = 0; i < done_; ++i) {
    if (tasks_[i].*kind != name) continue;
    work += tasks_[i].work;
    seconds += seconds_[i];
  }
  if (work <= 0.0) return std::nullopt;
  return seconds / work;
}

std::optional<double> SweepClock::expected(const SweepTask& task) const {
  std::optional<double> per_work = rate(&SweepTask::kind, task.kind);
  if (!per_work) per_work = rate(&SweepTask::general, task.general);
  if (!per_work) return std::nullopt;
  return *per_work * task.work;
}

std::optional<double> SweepClock::left(double elapsed, double fraction) const {
  double left = 0.0;
  for (std::size_t i = done_; i < tasks_.size(); ++i) {
    const std::optional<double> whole = expected(tasks_[i]);
    const bool under_way = i == done_;
    if (whole) {
      left += under_way ? std::max(0.0, *whole - elapsed) : *whole;
    } else if (under_way && fraction > 0.0) {
      left += elapsed / fraction * (1.0 - fraction);
    } else {
      return std::nullopt;
    }
  }
  return left;
}

}  // namespace gatelight::apps
