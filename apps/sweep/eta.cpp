#include "apps/sweep/eta.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using renderer::RenderOptions;

double pixels_of(const RenderOptions& o) {
  return static_cast<double>(o.width) * o.height;
}

/// Kinds of this scene first, then of any scene, and last of any picture.
std::vector<std::string> kinds_of(const PlannedScene& scene, const std::vector<std::string>& kinds) {
  std::vector<std::string> all;
  all.reserve(2 * kinds.size() + 1);
  for (const std::string& kind : kinds) all.push_back(fmt::format("{} {}", scene.name, kind));
  all.insert(all.end(), kinds.begin(), kinds.end());
  all.emplace_back("picture");
  return all;
}

}  // namespace

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

SweepTask run_task(const PlannedScene& scene, const PlannedSeries& series, const std::vector<int>& points) {
  const RenderOptions& o = series.settings.render;
  const std::string integrator = renderer::enum_name(o.integrator);
  int point = points.back();
  if (series.named) point = series.has_cache() ? o.cache.train_steps.value_or(0) : o.spp;
  if (!series.has_cache()) return {kinds_of(scene, {integrator}), pixels_of(o) * point};
  const std::string encoding = renderer::enum_name(o.cache.encoding);
  // Camera paths and training paths.
  const double work = pixels_of(o) * o.spp * static_cast<double>(points.size()) +
                      static_cast<double>(o.cache.batch) * o.cache.samples_per_point * point;
  return {kinds_of(scene, {fmt::format("{} {}", integrator, encoding), integrator}), work};
}

SweepTask reference_task(const PlannedScene& scene, const RenderOptions& cell, ReferenceKind kind, int spp) {
  return {kinds_of(scene, {renderer::name_of(kReferenceKinds, kind)}), pixels_of(cell) * spp};
}

std::vector<SweepTask> all_tasks(const PlannedScene& scene, const SweepPlan& plan, int reference_spp) {
  std::vector<SweepTask> tasks;
  std::set<ReferenceKind> kinds;
  for (const PlannedSeries& series : scene.series) {
    if (kinds.insert(series.reference).second) {
      tasks.push_back(reference_task(scene, series.settings.render, series.reference, reference_spp));
    }
    for (std::size_t seed = 0; seed < plan.seeds.size(); ++seed) {
      tasks.push_back(run_task(scene, series, series.points));
    }
  }
  return tasks;
}

}  // namespace gatelight::apps
