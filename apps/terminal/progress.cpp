#include "apps/terminal/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

/// JSON lines end up in log files, so one per second is enough. A bar moves faster.
constexpr double kJsonInterval = 1.0;
constexpr double kBarInterval = 0.1;

constexpr renderer::Choice<renderer::Phase> kPhases[] = {{"scout", renderer::Phase::scout},
                                                         {"train", renderer::Phase::train},
                                                         {"render", renderer::Phase::render},
                                                         {"denoise", renderer::Phase::denoise}};

/// The numbers that the bar shows of a phase besides its fraction.
std::string measures(const renderer::Progress& progress, double samples_per_second) {
  if (progress.phase == renderer::Phase::train) {
    // Before the first step there is no loss.
    const std::string loss = progress.steps_done > 0 ? fmt::format("  loss {:.3g}", progress.loss) : "";
    return fmt::format("  {}/{} steps{}", progress.steps_done, progress.steps, loss);
  }
  if (progress.phase == renderer::Phase::render) {
    const std::string goal = progress.spp < renderer::kUnlimitedSpp ? fmt::format("/{}", progress.spp) : "";
    const std::string error =
        progress.error ? fmt::format("error {}  ", format_percent(*progress.error)) : "";
    return fmt::format("  {}{} spp  {}{}{}samples/s", progress.spp_done, goal, error,
                       format_count(samples_per_second), samples_per_second < 999.5 ? " " : "");
  }
  return "";
}

}  // namespace

std::string word_of(renderer::Phase phase) {
  return renderer::name_of(kPhases, phase);
}

ProgressLine::ProgressLine(ProgressMode mode) : mode_(mode) {
  if (mode_ == ProgressMode::automatic)
    mode_ = ::isatty(STDERR_FILENO) == 1 ? ProgressMode::bar : ProgressMode::none;
}

void ProgressLine::clear() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

void ProgressLine::show_line(const std::string& text) {
  clear_line();
  print_status(text);
  std::fflush(stderr);
  line_shown_ = true;
}

void ProgressLine::clear_line() {
  if (!line_shown_) return;
  print_status("\r\x1b[K");
  std::fflush(stderr);
  line_shown_ = false;
}

bool ProgressLine::due(bool must) {
  const double interval = mode_ == ProgressMode::json ? kJsonInterval : kBarInterval;
  if (!must && seconds_since(last_) < interval) return false;
  last_ = Clock::now();
  return true;
}

ProgressReporter::ProgressReporter(ProgressMode mode, double pixels) : ProgressLine(mode), pixels_(pixels) {}

void ProgressReporter::phase(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (mode_ == ProgressMode::json) {
    print_json_line({{"event", "phase"}, {"phase", name}});
  } else if (mode_ == ProgressMode::bar) {
    show_line(fmt::format("{} ...", name));
  }
}

void ProgressReporter::update(const renderer::Progress& progress) {
  const std::lock_guard lock(mutex_);
  if (mode_ == ProgressMode::none) return;
  const bool first = enter_phase(progress);
  if (!due(first || progress.fraction >= 1.0)) return;
  if (mode_ == ProgressMode::bar) {
    show_bar(progress, rates(progress));
  } else {
    show_json(progress, rates(progress));
  }
}

bool ProgressReporter::enter_phase(const renderer::Progress& progress) {
  if (phase_ == progress.phase) return false;
  phase_ = progress.phase;
  first_ = progress;
  return true;
}

ProgressReporter::Rates ProgressReporter::rates(const renderer::Progress& progress) const {
  Rates rates;
  if (frame_) {
    rates.eta_seconds = eta_of_frames();
    return rates;
  }
  const double seconds = progress.seconds - first_.seconds;
  const double done = progress.fraction - first_.fraction;
  if (done > 0.0) rates.eta_seconds = seconds / done * std::max(0.0, 1.0 - progress.fraction);
  if (progress.phase != renderer::Phase::render) return rates;
  if (seconds > 0.0) rates.samples_per_second = (progress.samples - first_.samples) * pixels_ / seconds;
  return rates;
}

void ProgressReporter::show_json(const renderer::Progress& progress, const Rates& rates) {
  nlohmann::ordered_json line = {
      {"event", "progress"}, {"phase", word_of(progress.phase)}, {"fraction", progress.fraction}};
  if (progress.phase == renderer::Phase::train) {
    line["steps_done"] = progress.steps_done;
    line["steps"] = progress.steps;
    if (progress.steps_done > 0) line["loss"] = progress.loss;
  } else if (progress.phase == renderer::Phase::render) {
    line["spp_done"] = progress.spp_done;
    line["spp"] = progress.spp;
    line["samples_per_second"] = rates.samples_per_second;
    if (progress.error) line["estimated_error"] = *progress.error;
  }
  if (frame_) {
    line["frame"] = frame_->number;
    line["frames_done"] = frame_->done;
    line["frames"] = frame_->count;
  }
  line["seconds"] = progress.seconds;
  if (rates.eta_seconds >= 0.0) line["eta_seconds"] = rates.eta_seconds;
  print_json_line(line);
}

void ProgressReporter::show_bar(const renderer::Progress& progress, const Rates& rates) {
  std::string name = word_of(progress.phase);
  if (frame_)
    name = fmt::format("frame {} ({} of {}) {}", frame_->number, frame_->done + 1, frame_->count, name);
  const std::string numbers = fmt::format(" {:5.1f} %{}  ETA {}", 100.0 * progress.fraction,
                                          measures(progress, rates.samples_per_second),
                                          rates.eta_seconds < 0.0 ? "?" : format_duration(rates.eta_seconds));
  // "NAME [" and "]", and the last column stays free: some terminals wrap there.
  const int room = terminal_columns() - static_cast<int>(name.size() + numbers.size()) - 4;
  const int width = std::clamp(room, 0, 40);
  const int filled = static_cast<int>(std::floor(std::clamp(progress.fraction, 0.0, 1.0) * width));
  const std::string bar = fmt::format("{} [{:=<{}}{: <{}}]", name, "", filled, "", width - filled);
  show_line(width >= 8 ? bar + numbers : numbers);
}

void ProgressReporter::begin_frame(int frame, std::size_t done, std::size_t count) {
  const std::lock_guard lock(mutex_);
  if (!frame_) first_frame_ = Clock::now();
  frame_ = Frame{frame, done, count, Clock::now()};
  phase_.reset();
}

bool ProgressReporter::frame_done(int frame, const nlohmann::ordered_json& summary) {
  const std::lock_guard lock(mutex_);
  if (mode_ != ProgressMode::json) return false;
  nlohmann::ordered_json line = {{"event", "frame"}, {"frame", frame}};
  line.update(summary);
  print_json_line(line);
  return true;
}

double ProgressReporter::eta_of_frames() const {
  if (frame_->done == 0) return -1.0;
  const double each =
      std::chrono::duration<double>(frame_->begin - first_frame_).count() / static_cast<double>(frame_->done);
  const double left = each * static_cast<double>(frame_->count - frame_->done);
  return std::max(left - seconds_since(frame_->begin), 0.0);
}

bool ProgressReporter::done(const nlohmann::ordered_json& summary) {
  const std::lock_guard lock(mutex_);
  clear_line();
  if (mode_ != ProgressMode::json) return false;
  nlohmann::ordered_json line = {{"event", "done"}};
  line.update(summary);
  print_json_line(line);
  return true;
}

}  // namespace gatelight::apps
