#include "apps/sweep/sweep_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

std::string describe(const renderer::Progress& p) {
  std::string text = word_of(p.phase);
  if (p.phase == renderer::Phase::train) text += fmt::format(" {}/{} steps", p.steps_done, p.steps);
  if (p.phase == renderer::Phase::render) text += fmt::format(" {}/{} spp", p.spp_done, p.spp);
  return text;
}

std::string eta_text(const std::optional<double>& left) {
  return left ? format_duration(*left) : "unknown";
}

double pixels_of(const renderer::RenderOptions& o) {
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
  const renderer::RenderOptions& o = series.settings.render;
  const std::string integrator = renderer::enum_name(o.integrator);
  int point = points.back();
  if (series.named) point = series.has_cache() ? o.cache.train_steps.value_or(0) : o.spp;
  if (!series.has_cache()) return {integrator, pixels_of(o) * point};
  // Camera paths and training paths.
  const double work = pixels_of(o) * o.spp * static_cast<double>(points.size()) +
                      static_cast<double>(o.cache.batch) * o.cache.samples_per_point * point;
  return {fmt::format("{} {}", integrator, renderer::enum_name(o.cache.encoding)), work};
}

SweepTask reference_task(const renderer::RenderOptions& cell, ReferenceKind kind, int spp) {
  return {renderer::name_of(kReferenceKinds, kind), pixels_of(cell) * spp};
}

SweepProgress::SweepProgress(ProgressMode mode, bool quiet)
    : ProgressLine(quiet ? ProgressMode::none : mode), words_(!quiet && mode_ != ProgressMode::json) {}

void SweepProgress::plan_rest(const std::vector<SweepTask>& tasks) {
  const std::lock_guard lock(mutex_);
  clock_.plan_rest(tasks);
}

void SweepProgress::phase(const std::string& what, double fraction) {
  const std::lock_guard lock(mutex_);
  show(what, fraction, fraction == 0.0);
}

void SweepProgress::begin(const std::string& task, bool one_piece) {
  const std::lock_guard lock(mutex_);
  task_ = task;
  one_piece_ = one_piece;
  task_start_ = Clock::now();
  cells_ = 0;
  show("", 0.0, true);
}

void SweepProgress::update(const renderer::Progress& progress) {
  const std::lock_guard lock(mutex_);
  show(describe(progress), progress.fraction, false);
}

void SweepProgress::cell(const std::string& id, const std::string& status) {
  const std::lock_guard lock(mutex_);
  ++cells_;
  if (mode_ == ProgressMode::json) {
    print_json_line({{"event", "cell"}, {"id", id}, {"status", status}, {"task", task_}});
  }
}

void SweepProgress::end() {
  const std::lock_guard lock(mutex_);
  clock_.finish(seconds_since(task_start_));
  clear_line();
  const std::optional<double> left = clock_.left(0.0, 0.0);
  if (mode_ == ProgressMode::json) {
    print_json_line(event("task", seconds_since(task_start_), left));
  } else if (words_) {
    print_status(fmt::format("{}/{}  {}{} in {:.1f} s; left {}\n", clock_.done(), clock_.count(), task_,
                             cells_ > 0 ? fmt::format(": {} cell{}", cells_, cells_ == 1 ? "" : "s") : "",
                             seconds_since(task_start_),
                             clock_.done() == clock_.count() ? "nothing" : eta_text(left)));
  }
}

void SweepProgress::done(const std::string& folder, std::size_t cells, std::size_t failed) {
  const std::lock_guard lock(mutex_);
  clear_line();
  if (mode_ == ProgressMode::json) {
    print_json_line({{"event", "done"},
                     {"folder", folder},
                     {"cells", cells},
                     {"failed", failed},
                     {"seconds", seconds_since(start_)}});
  } else if (words_) {
    print_status(fmt::format("{} cells{} in '{}', {} in this call\n", cells,
                             failed > 0 ? fmt::format(", {} of them failed,", failed) : "", folder,
                             format_duration(seconds_since(start_))));
  }
}

nlohmann::ordered_json SweepProgress::event(const char* name, double seconds,
                                            const std::optional<double>& left) const {
  nlohmann::ordered_json line = {{"event", name},
                                 {"task", task_},
                                 {"tasks_done", clock_.done()},
                                 {"tasks", clock_.count()},
                                 {"seconds", seconds}};
  if (left) line["eta_seconds"] = *left;
  return line;
}

void SweepProgress::show(const std::string& what, double fraction, bool must) {
  if (mode_ == ProgressMode::none || !due(must)) return;
  const std::optional<double> left = clock_.left(seconds_since(task_start_), one_piece_ ? fraction : 0.0);
  if (mode_ == ProgressMode::json) {
    nlohmann::ordered_json line = event("progress", seconds_since(start_), left);
    line["phase"] = what;
    line["fraction"] = fraction;
    print_json_line(line);
    return;
  }
  std::string text =
      fmt::format("{}/{}  {}  {}  {:.0f} %  ETA {}", std::min(clock_.done() + 1, clock_.count()),
                  clock_.count(), task_, what, 100.0 * fraction, eta_text(left));
  // The last column stays free: some terminals wrap there.
  const auto room = static_cast<std::size_t>(std::max(1, terminal_columns() - 1));
  if (text.size() > room) text.resize(room);
  show_line(text);
}

}  // namespace gatelight::apps
