#include "apps/sweep/sweep_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

constexpr double kJsonInterval = 1.0;
constexpr double kBarInterval = 0.1;

std::string describe(const renderer::Progress& p) {
  switch (p.phase) {
    case renderer::Phase::scout:
      return "scout";
    case renderer::Phase::train:
      return fmt::format("train {}/{} steps", p.steps_done, p.steps);
    case renderer::Phase::render:
      return fmt::format("render {}/{} spp", p.spp_done, p.spp);
  }
  return "";
}

std::string eta_text(const std::optional<double>& left) {
  return left ? format_duration(*left) : "unknown";
}

}  // namespace

SweepProgress::SweepProgress(ProgressMode mode, bool quiet) : mode_(mode), words_(!quiet) {
  if (mode_ == ProgressMode::automatic) {
    mode_ = ::isatty(STDERR_FILENO) == 1 ? ProgressMode::bar : ProgressMode::none;
  }
  if (quiet) mode_ = ProgressMode::none;
  if (mode_ == ProgressMode::json) words_ = false;
}

SweepProgress::~SweepProgress() {
  clear();
}

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
  watch_ = Stopwatch();
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
  clock_.finish(watch_.seconds());
  clear_line();
  const std::optional<double> left = clock_.left(0.0, 0.0);
  if (mode_ == ProgressMode::json) {
    nlohmann::ordered_json line = {{"event", "task"},
                                   {"task", task_},
                                   {"tasks_done", clock_.done()},
                                   {"tasks", clock_.count()},
                                   {"seconds", watch_.seconds()}};
    if (left) line["eta_seconds"] = *left;
    print_json_line(line);
  } else if (words_) {
    tell(fmt::format("{}/{}  {}{} in {:.1f} s; left {}\n", clock_.done(), clock_.count(), task_,
                     cells_ > 0 ? fmt::format(": {} cell{}", cells_, cells_ == 1 ? "" : "s") : "",
                     watch_.seconds(), clock_.done() == clock_.count() ? "nothing" : eta_text(left)));
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
                     {"seconds", total_.seconds()}});
  } else if (words_) {
    tell(fmt::format("{} cells{} in '{}', {} in this call\n", cells,
                     failed > 0 ? fmt::format(", {} of them failed,", failed) : "", folder,
                     format_duration(total_.seconds())));
  }
}

void SweepProgress::clear() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

void SweepProgress::show(const std::string& what, double fraction, bool must) {
  if (mode_ == ProgressMode::none) return;
  const auto now = std::chrono::steady_clock::now();
  const double interval = mode_ == ProgressMode::json ? kJsonInterval : kBarInterval;
  if (!must && std::chrono::duration<double>(now - last_).count() < interval) return;
  last_ = now;
  const std::optional<double> left = clock_.left(watch_.seconds(), one_piece_ ? fraction : 0.0);
  if (mode_ == ProgressMode::json) {
    nlohmann::ordered_json line = {{"event", "progress"},
                                   {"task", task_},
                                   {"phase", what},
                                   {"fraction", fraction},
                                   {"tasks_done", clock_.done()},
                                   {"tasks", clock_.count()},
                                   {"seconds", total_.seconds()}};
    if (left) line["eta_seconds"] = *left;
    print_json_line(line);
    return;
  }
  clear_line();
  std::string text =
      fmt::format("{}/{}  {}  {}  {:.0f} %  ETA {}", std::min(clock_.done() + 1, clock_.count()),
                  clock_.count(), task_, what, 100.0 * fraction, eta_text(left));
  // The last column stays free: some terminals wrap there.
  const auto room = static_cast<std::size_t>(std::max(1, terminal_columns() - 1));
  if (text.size() > room) text.resize(room);
  tell(text);
  std::fflush(stderr);
  line_shown_ = true;
}

void SweepProgress::clear_line() {
  if (!line_shown_) return;
  tell("\r\x1b[K");
  std::fflush(stderr);
  line_shown_ = false;
}

}  // namespace gatelight::apps
