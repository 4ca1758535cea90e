#include "renderer/driver/sample_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "renderer/cache/cached_pass.h"
#include "renderer/driver/time_budget.h"
#include "renderer/transport/reference_pass.h"

namespace gatelight::renderer {
namespace {

/// A pass takes about this long, so that time limits, signals and snapshots are handled soon.
constexpr double kPassSeconds = 0.7;
/// The processes of a team wait for each other after each pass, and their speeds jump.
constexpr double kPassSecondsOfTeam = 3.0;

std::unique_ptr<Pass> make_pass(const RenderContext& context, Training* training) {
  const PreparedPicture& picture = context.picture;
  const PassContext inputs{context.team.own(), picture.options, picture.camera, picture.filter};
  if (training) return std::make_unique<CachedPass>(*picture.world, inputs, training->session());
  return std::make_unique<ReferencePass>(*picture.world, inputs);
}

}  // namespace

SampleLoop::SampleLoop(const RenderContext& context, Film& film, Training* training, int spp)
    : picture_(context.picture),
      callbacks_(context.callbacks),
      team_(context.team),
      film_(film),
      pass_(make_pass(context, training)),
      spp_(spp) {}

void SampleLoop::end_at(Clock::time_point end, bool in_part) {
  end_ = std::chrono::duration<double>(end - start_).count();
  in_part_ = in_part;
}

void SampleLoop::report_error(double error, double samples) {
  error_ = error;
  expected_samples_ = samples;
}

void SampleLoop::run_pass(int goal) {
  const int batch = std::min(batch_, goal - done_);
  // Each pixel needs a sample, and a pass of several is not cut because it was chosen to fit.
  const bool in_part = in_part_ && batch == 1 && done_ > 0;
  pass_->end_at(in_part ? start_ +
                              std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(end_))
                        : Clock::time_point::max());
  const double begin = now();
  picture_.arena.execute([&] {
    pass_->run(batch, film_, [&](double fraction) {
      callbacks_.check_abandoned();
      if (callbacks_.stop && callbacks_.stop()) stop_ = true;
      report(fraction, batch);
    });
  });
  note_pass(batch, now() - begin);
}

void SampleLoop::note_pass(int batch, double seconds) {
  // A process without tiles did not poll the callback during the pass.
  if (!team_.is_alone() && callbacks_.stop && callbacks_.stop()) stop_ = true;
  const RayCounts counts = pass_->rays();
  const std::uint64_t rays = counts.camera + counts.bounce + counts.shadow;
  PassReport mine{{seconds, rays - rays_}, stop_, pass_->cut_short(), {}, false};
  rays_ = rays;
  if (picture_.options.nan_policy == NanPolicy::error) {
    const std::vector<NonFiniteSample> found = pass_->counts().located;
    mine.found_nonfinite = !found.empty();
    if (mine.found_nonfinite) mine.nonfinite = found[0];
  }
  last_pass_.clear();
  double slowest = 0.0;
  std::vector<NonFiniteSample> located;
  for (const PassReport& report : team_.of_each(mine)) {
    last_pass_.push_back(report.work);
    slowest = std::max(slowest, report.work.seconds);
    if (report.stop) stop_ = true;
    cut_short_ |= report.cut_short;
    if (report.found_nonfinite) located.push_back(report.nonfinite);
  }
  keep_first(located);
  if (!located.empty()) {
    throw NumericalError(fmt::format("sample {} of pixel {},{} (seed {}) is not finite", located[0].sample,
                                     located[0].x, located[0].y, located[0].seed));
  }
  if (!cut_short_) done_ += batch;
  per_sample_ = slowest / batch;
  const double usual = team_.is_alone() ? kPassSeconds : kPassSecondsOfTeam;
  batch_ = team_.agreed(samples_of_pass(now(), per_sample_, usual, end_, 2 * batch));
}

bool SampleLoop::over() const {
  return team_.any(stop_ || cut_short_ || now() >= end_ ||
                   (!in_part_ && !pass_fits(now(), per_sample_, end_)));
}

Progress SampleLoop::progress(double samples) const {
  const double seconds = this->seconds();
  double fraction = samples / spp_;
  if (expected_samples_ > 0.0) fraction = std::max(fraction, samples / expected_samples_);
  if (std::isfinite(end_)) fraction = std::max(fraction, now() / std::max(end_, 1e-9));
  const int of_pixel = picture_.options.denoise.film_pixels_per_pixel();
  return {.spp_done = done_ * of_pixel,
          .spp = spp_ == kUnlimitedSpp ? spp_ : spp_ * of_pixel,
          .samples = samples * of_pixel,
          .error = error_,
          .fraction = std::min(fraction, 1.0),
          .seconds = seconds};
}

void SampleLoop::report(double of_pass, int batch) {
  if (!callbacks_.progress) return;
  const std::unique_lock lock(report_mutex_, std::try_to_lock);
  const double now = seconds();
  if (!lock || now - last_report_ < 0.1) return;
  last_report_ = now;
  callbacks_.progress(progress(done_ + of_pass * batch));
}

void SampleLoop::report_end() const {
  if (!callbacks_.progress) return;
  Progress end = progress(done_);
  end.fraction = 1.0;
  callbacks_.progress(end);
}

}  // namespace gatelight::renderer
