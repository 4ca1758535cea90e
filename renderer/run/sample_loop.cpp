#include "renderer/run/sample_loop.h"

#include <fmt/format.h>

#include <algorithm>

namespace gatelight::renderer {
namespace {

/// A pass takes about this long, so that time limits, signals and snapshots are handled soon.
constexpr double kPassSeconds = 0.7;

}  // namespace

SampleLoop::SampleLoop(tbb::task_arena& arena, const RenderOptions& options, const Callbacks& callbacks,
                       Pass& pass, Film& film, int spp)
    : arena_(arena), options_(options), callbacks_(callbacks), pass_(pass), film_(film), spp_(spp) {}

void SampleLoop::run_pass(int goal) {
  const int batch = std::min(batch_, goal - done_);
  const double begin = seconds();
  arena_.execute([&] {
    pass_.run(batch, film_, [&](double fraction) {
      if (callbacks_.stop && callbacks_.stop()) stop_ = true;
      report(fraction, batch);
    });
  });
  done_ += batch;
  last_seconds_ = seconds();
  if (options_.nan_policy == NanPolicy::error) {
    const std::vector<NonFiniteSample> located = pass_.counts().located;
    if (!located.empty()) {
      throw NumericalError(fmt::format("sample {} of pixel {},{} (seed {}) is not finite", located[0].sample,
                                       located[0].x, located[0].y, located[0].seed));
    }
  }
  const double per_sample = (last_seconds_ - begin) / batch;
  double budget = kPassSeconds;
  if (options_.time_limit_seconds > 0.0)
    budget = std::min(budget, options_.time_limit_seconds - last_seconds_);
  batch_ = std::max(1, std::min(2 * batch, static_cast<int>(budget / std::max(per_sample, 1e-9))));
}

bool SampleLoop::over() const {
  return stop_ || (options_.time_limit_seconds > 0.0 && last_seconds_ >= options_.time_limit_seconds);
}

void SampleLoop::report(double of_pass, int batch) {
  if (!callbacks_.progress) return;
  const std::unique_lock lock(report_mutex_, std::try_to_lock);
  const double now = seconds();
  if (!lock || now - last_report_ < 0.1) return;
  last_report_ = now;
  callbacks_.progress(
      {.spp_done = done_, .spp = spp_, .fraction = (done_ + of_pass * batch) / spp_, .seconds = now});
}

void SampleLoop::report_end() const {
  if (callbacks_.progress)
    callbacks_.progress({.spp_done = done_, .spp = spp_, .fraction = 1.0, .seconds = seconds()});
}

}  // namespace gatelight::renderer
