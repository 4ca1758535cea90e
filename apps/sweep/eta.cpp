#include "apps/sweep/eta.h"

#include <algorithm>

namespace gatelight::apps {

void SweepClock::plan_rest(const std::vector<SweepTask>& tasks) {
  tasks_.resize(done_);
  tasks_.insert(tasks_.end(), tasks.begin(), tasks.end());
}

void SweepClock::finish(double seconds) {
  if (done_ < tasks_.size()) {
    const SweepTask& task = tasks_[done_];
    for (const std::string& kind : task.kinds) {
      Sum& sum = sums_[kind];
      sum.work += task.work;
      sum.seconds += seconds;
    }
  }
  ++done_;
}

std::optional<double> SweepClock::expected(const SweepTask& task) const {
  for (const std::string& kind : task.kinds) {
    const auto sum = sums_.find(kind);
    if (sum != sums_.end() && sum->second.work > 0.0)
      return sum->second.seconds / sum->second.work * task.work;
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
