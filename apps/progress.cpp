#include "apps/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/text.h"

namespace gatelight::apps {
namespace {

/// JSON lines end up in log files: one a second is enough. A bar may move faster.
constexpr double kJsonInterval = 1.0;
constexpr double kBarInterval = 0.1;

int terminal_columns() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

void print_json(const nlohmann::ordered_json& object) {
  fmt::print(stderr, "{}\n", object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  std::fflush(stderr);
}

}  // namespace

ProgressReporter::ProgressReporter(ProgressMode mode, double pixels, double time_limit_seconds)
    : mode_(mode), pixels_(pixels), time_limit_seconds_(time_limit_seconds) {
  if (mode_ == ProgressMode::automatic) {
    mode_ = ::isatty(STDERR_FILENO) == 1 ? ProgressMode::bar : ProgressMode::none;
  }
}

ProgressReporter::~ProgressReporter() {
  clear();
}

void ProgressReporter::phase(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (mode_ == ProgressMode::json) {
    print_json({{"event", "phase"}, {"phase", name}});
  } else if (mode_ == ProgressMode::bar) {
    clear_line();
    fmt::print(stderr, "{} ...", name);
    std::fflush(stderr);
    line_shown_ = true;
  }
}

void ProgressReporter::update(const renderer::Progress& progress) {
  const std::lock_guard lock(mutex_);
  if (mode_ == ProgressMode::none) return;
  const auto now = std::chrono::steady_clock::now();
  const double interval = mode_ == ProgressMode::json ? kJsonInterval : kBarInterval;
  const bool last = progress.fraction >= 1.0;
  if (any_update_ && !last && std::chrono::duration<double>(now - last_).count() < interval) return;
  any_update_ = true;
  last_ = now;

  const double samples = progress.fraction * pixels_ * progress.spp;
  const double samples_per_second = progress.seconds > 0.0 ? samples / progress.seconds : 0.0;
  double eta = progress.fraction > 0.0 ? progress.seconds * (1.0 / progress.fraction - 1.0) : -1.0;
  if (time_limit_seconds_ > 0.0) {
    const double left = std::max(0.0, time_limit_seconds_ - progress.seconds);
    eta = eta < 0.0 ? left : std::min(eta, left);
  }
  if (mode_ == ProgressMode::bar) {
    show_bar(progress, samples_per_second, eta);
    return;
  }
  nlohmann::ordered_json line = {{"event", "progress"},           {"fraction", progress.fraction},
                                 {"spp_done", progress.spp_done}, {"spp", progress.spp},
                                 {"seconds", progress.seconds},   {"samples_per_second", samples_per_second}};
  if (eta >= 0.0) line["eta_seconds"] = eta;
  print_json(line);
}

void ProgressReporter::show_bar(const renderer::Progress& progress, double samples_per_second,
                                double eta_seconds) {
  const std::string numbers =
      fmt::format(" {:5.1f} %  {}/{} spp  {}samples/s  ETA {}", 100.0 * progress.fraction, progress.spp_done,
                  progress.spp, format_count(samples_per_second) + (samples_per_second < 999.5 ? " " : ""),
                  eta_seconds < 0.0 ? "?" : format_duration(eta_seconds));
  // "render [" and "]", and the last column stays free: some terminals wrap there.
  const int room = terminal_columns() - static_cast<int>(numbers.size()) - 10;
  const int width = std::clamp(room, 0, 40);
  const int filled = static_cast<int>(std::floor(std::clamp(progress.fraction, 0.0, 1.0) * width));
  clear_line();
  if (width >= 8) fmt::print(stderr, "render [{:=<{}}{: <{}}]", "", filled, "", width - filled);
  fmt::print(stderr, "{}", numbers);
  std::fflush(stderr);
  line_shown_ = true;
}

bool ProgressReporter::done(const std::vector<std::string>& outputs, double seconds) {
  const std::lock_guard lock(mutex_);
  clear_line();
  if (mode_ != ProgressMode::json) return false;
  print_json({{"event", "done"}, {"outputs", outputs}, {"seconds", seconds}});
  return true;
}

void ProgressReporter::clear() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

void ProgressReporter::clear_line() {
  if (!line_shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  line_shown_ = false;
}

}  // namespace gatelight::apps
