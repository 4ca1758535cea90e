#include "apps/sweep/eta.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using renderer::RenderOptions;

double pixels_of(const RenderOptions& o) {
  return static_cast<double>(o.width) * o.height;
}

}  // namespace

void SweepClock::plan_rest(const std::vector<SweepTask>& tasks) {
  tasks_.resize(done_);
  tasks_.insert(tasks_.end(), tasks.begin(), tasks.end());
}

void SweepClock::finish(double seconds) {
  if (done_ < tasks_.size()) {
    const SweepTask& task = tasks_[done_];
    for (Sum* sum : {&finished_, &finished_of_kind_[task.kind]}) {
      sum->work += task.work;
      sum->seconds += seconds;
    }
  }
  ++done_;
}

std::optional<double> SweepClock::expected(const SweepTask& task) const {
  const auto same = finished_of_kind_.find(task.kind);
  const Sum& sum = same == finished_of_kind_.end() ? finished_ : same->second;
  return sum.work > 0.0 ? std::optional(sum.seconds / sum.work * task.work) : std::nullopt;
}

std::optional<double> SweepClock::left(double elapsed, double fraction) const {
  if (tasks_.empty()) return std::nullopt;
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

SweepTask run_task(const PlannedSeries& series, const std::vector<int>& points) {
  const RenderOptions& o = series.settings.render;
  const std::string integrator = renderer::enum_name(o.integrator);
  int point = points.back();
  if (series.named) point = series.has_cache() ? o.cache.train_steps.value_or(0) : o.spp;
  if (!series.has_cache()) return {integrator, pixels_of(o) * point};
  // Camera paths and training paths.
  const double work = pixels_of(o) * o.spp * static_cast<double>(points.size()) +
                      static_cast<double>(o.cache.batch) * o.cache.samples_per_point * point;
  return {fmt::format("{} {}", integrator, renderer::enum_name(o.cache.encoding)), work};
}

SweepTask reference_task(const RenderOptions& cell, ReferenceKind kind, int spp) {
  return {renderer::name_of(kReferenceKinds, kind), pixels_of(cell) * spp};
}

}  // namespace gatelight::apps
