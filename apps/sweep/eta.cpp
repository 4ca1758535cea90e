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

std::optional<double> SweepClock::rate(const std::string& kind) const {
  double work = 0.0;
  double seconds = 0.0;
  for (std::size_t i = 0; i < done_; ++i) {
    const std::vector<std::string>& kinds = tasks_[i].kinds;
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) continue;
    work += tasks_[i].work;
    seconds += seconds_[i];
  }
  if (work <= 0.0) return std::nullopt;
  return seconds / work;
}

std::optional<double> SweepClock::expected(const SweepTask& task) const {
  for (const std::string& kind : task.kinds) {
    if (const std::optional<double> per_work = rate(kind)) return *per_work * task.work;
  }
  return std::nullopt;
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
