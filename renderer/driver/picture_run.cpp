// Renderer::render: one picture from start to end.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "base/clock.h"
#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "base/platform/flush_denormals.h"
#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/distributed/packing.h"
#include "renderer/distributed/shared_file.h"
#include "renderer/driver/error_checks.h"
#include "renderer/driver/finished_picture.h"
#include "renderer/driver/implementation.h"
#include "renderer/driver/sample_loop.h"
#include "renderer/driver/time_budget.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

class Renderer::Implementation::PictureRun {
 public:
  PictureRun(Implementation& renderer, const Callbacks& callbacks)
      : renderer_(renderer),
        options_(renderer.options),
        callbacks_(callbacks),
        ranks_(renderer.ranks),
        film_(renderer.make_film()) {
    renderer_.begin = begin_;
    renderer_.traffic_before = ranks_.traffic();
  }

  Picture make() {
    restore();
    plan();
    train();
    write_cache();
    const std::unique_ptr<Pass> pass = renderer_.make_pass(training_);
    SampleLoop loop(renderer_.arena, options_, callbacks_, *pass, film_, options_.spp, ranks_);
    run_passes(loop, *pass);
    end(loop, *pass);
    Picture picture = finished(loop);
    if (ranks_.first()) add_cryptomattes(picture, std::move(mattes_));
    note_end(loop);
    return picture;
  }

 private:
  void restore() {
    const CacheOptions& cache = options_.cache;
    const bool keeps = !options_.checkpoint.file.empty();
    const bool caches = uses_cache(options_.integrator);
    if (caches && !cache.cache_out.empty() && ranks_.first()) check_writable(cache.cache_out);
    if (keeps || (caches && !(cache.cache_in.empty() && cache.cache_out.empty())))
      fingerprint_ = renderer_.scene_fingerprint();
    if (!keeps) return;
    const std::string& file = options_.checkpoint.file;
    identity_ = renderer_.identity(fingerprint_);
    if (ranks_.first()) check_writable(file);
    if (!options_.checkpoint.resume || !agreed(ranks_, ranks_.first() && std::filesystem::exists(file)))
      return;
    shared_ = share_file(ranks_, file);
    found_.emplace(shared_.path());
    found_->expect(*identity_, options_.spp);
    found_->restore(film_, earlier_);
  }

  /// Work whose time does not depend on the picture's samples comes first, so that a time limit includes it.
  void plan() {
    mattes_ = renderer_.cryptomattes();
    budget_.limit = options_.time_limit_seconds;
    if (budget_.limit <= 0.0) return;
    budget_.shadows = agreed(ranks_, renderer_.expect_shadow_seconds());
    budget_.denoise = agreed(ranks_, renderer_.expect_denoise_seconds());
  }

  Clock::time_point time_at(double seconds) const {
    constexpr double kMost = 1e9;  // a clock counts some centuries at most
    const std::chrono::duration<double> after(std::min(seconds, kMost));
    return begin_ + std::chrono::duration_cast<Clock::duration>(after);
  }

  void train() {
    if (!uses_cache(options_.integrator)) return;
    training_ = renderer_.begin_training(found(), fingerprint_, callbacks_);
    if (training_.complete) return;
    if (budget_.limit > 0.0) {
      const bool samples = options_.cache.source == TrainingSource::picture;
      training_.end = time_at(budget_.training_end(seconds_since(begin_), samples));
    }
    try {
      renderer_.train(training_, film_, callbacks_, [&] {
        if (!checkpoint_due()) return;
        training_.session->synchronize();
        keep(Phase::train, 0, sum_up(), true);
      });
    } catch (const TrainingDiverged& error) {
      // The last good state still gives a picture and a cache file. The checkpoint is kept.
      if (!renderer_.return_to_good(training_, film_, found(), earlier_, callbacks_)) throw;
      training_.diverged = error.what();
      identity_.reset();
    }
    // Training that a time limit ended is not repeated: its end decides the picture.
    keep(whole() ? Phase::render : Phase::train, 0, sum_up(), whole());
  }

  void write_cache() const {
    if (!training_.session || !whole() || options_.cache.cache_out.empty() || !ranks_.first()) return;
    try_writing(false, [&] {
      write_cache_file(options_.cache.cache_out, training_.session->export_state(),
                       training_.session->model(), training_options(options_),
                       {options_, resolve_ao_distance(options_.ao_distance, renderer_.scene.bounds)},
                       fingerprint_);
    });
  }

  void run_passes(SampleLoop& loop, const Pass& pass) {
    loop.begin_at(earlier_.spp);
    limit_passes(loop);
    if (training_.stopped) loop.stop();
    if (options_.max_error > 0.0 && is_check(loop.done()) && good_enough(loop)) return;
    while (loop.done() < options_.spp) {
      int goal = options_.spp;
      if (options_.max_error > 0.0) goal = std::min(goal, next_check(loop.done()));
      try {
        loop.run_pass(goal);
      } catch (const DeviceLost& error) {
        // Each pixel is the mean of its own samples, so an incomplete pass is a picture. A checkpoint could
        // not resume from it; the last checkpoint is kept.
        if (loop.done() == 0 || !ranks_.is_single()) throw;
        device_lost_ = error.what();
        return;
      }
      if (loop.done() == options_.spp) return;
      limit_passes(loop);
      const bool wanted = callbacks_.snapshot_wanted && callbacks_.snapshot && callbacks_.snapshot_wanted();
      if (any(ranks_, wanted)) {
        renderer_.statistics = sum_up(loop, pass);
        Picture picture = finished(loop);
        if (ranks_.first()) {
          add_cryptomattes(picture, mattes_);
          callbacks_.snapshot(picture);
        }
      }
      if (loop.over()) return;
      if (options_.max_error > 0.0 && is_check(loop.done()) && (good_enough(loop) || loop.over())) return;
      renderer_.rebalance(film_, loop.last_pass());
      if (whole() && checkpoint_due()) keep(Phase::render, loop.done(), sum_up(loop, pass), true);
    }
  }

  void limit_passes(SampleLoop& loop) {
    if (budget_.limit <= 0.0) return;
    // A checkpoint holds whole passes.
    loop.end_at(time_at(budget_.passes_end()), !identity_);
  }

  /// Estimates the error.
  bool good_enough(SampleLoop& loop) {
    const Clock::time_point start = Clock::now();
    const std::optional<double> error = renderer_.estimate_error(film_);
    loop.leave_out(seconds_since(start));
    if (!error) return false;
    const double times = *error / options_.max_error;
    loop.report_error(*error, loop.done() * times * times);
    return reached_error_ = *error <= options_.max_error;
  }

  void end(const SampleLoop& loop, const Pass& pass) {
    RenderStatistics& statistics = renderer_.statistics;
    statistics = sum_up(loop, pass);
    statistics.device_lost = device_lost_;
    if (whole() && device_lost_.empty()) keep(Phase::render, loop.done(), statistics, false);
    loop.report_end();
  }

  /// Stores the cause of the picture's end. Its error is known by now.
  void note_end(const SampleLoop& loop) {
    RenderStatistics& statistics = renderer_.statistics;
    if (!device_lost_.empty()) {
      statistics.ended_by = EndedBy::device;
    } else if (denoising_stopped_ || (loop.stopped() && (loop.done() < options_.spp || !whole()))) {
      statistics.ended_by = EndedBy::caller;
    } else if (reached_error_) {
      statistics.ended_by = EndedBy::max_error;
    } else {
      statistics.ended_by = loop.done() < options_.spp ? EndedBy::time_limit : EndedBy::spp;
    }
    const bool early = statistics.ended_by != EndedBy::max_error && loop.done() < options_.spp;
    statistics.interrupted = early || !whole() || denoising_stopped_;
  }

  /// The picture of the film, with its statistics.
  Picture finished(const SampleLoop& loop) {
    FinishedPicture finished = renderer_.finish(film_, callbacks_, loop.stopped());
    renderer_.add_statistics(finished);
    denoising_stopped_ = finished.stopped;
    return std::move(finished.picture);
  }
  Checkpoint* found() { return found_ ? &*found_ : nullptr; }
  /// A picture from an incomplete cache is a preview; it is never resumed.
  bool whole() const { return !training_.session || training_.complete; }
  /// Statistics before the first pass.
  RenderStatistics sum_up() const { return renderer_.sum_up(0, 0.0, film_, nullptr, training_, earlier_); }
  RenderStatistics sum_up(const SampleLoop& loop, const Pass& pass) const {
    return renderer_.sum_up(loop.done(), loop.seconds(), film_, &pass, training_, earlier_);
  }
  bool checkpoint_due() const {
    return identity_ && agreed(ranks_, seconds_since(last_checkpoint_) >= options_.checkpoint.every_seconds);
  }
  /// Writes a checkpoint where one is wanted. `samples`: of the film's pixels. `again`: another one will be
  /// tried.
  void keep(Phase phase, int samples, const RenderStatistics& sum, bool again) {
    if (!identity_) return;
    renderer_.gather(film_);
    last_checkpoint_ = Clock::now();
    if (!ranks_.first()) return;
    const CheckpointProgress progress{phase, samples, training_.first_step, training_.samples() > 0};
    try_writing(again, [&] {
      const neural::TrainingOptions training = training_options(options_);
      std::optional<CacheState> state;
      std::optional<CheckpointCache> cache;
      if (training_.session) {
        state = training_.session->export_state();
        cache.emplace(CheckpointCache{*state, training_.session->model(), training});
      }
      write_checkpoint(options_.checkpoint.file, *identity_, progress, sum, film_, cache);
    });
    last_checkpoint_ = Clock::now();  // after a failure too, so that the next try is not immediate
  }

  /// A full disk, or too little memory for a copy of the state, costs the file but not the picture.
  void try_writing(bool again, const std::function<void()>& write) const {
    if (!callbacks_.output_failed) return write();
    try {
      write();
    } catch (const OutputError&) {
      callbacks_.output_failed(std::current_exception(), again);
    } catch (const std::bad_alloc&) {
      callbacks_.output_failed(std::current_exception(), again);
    }
  }

  Implementation& renderer_;
  const RenderOptions& options_;
  const Callbacks& callbacks_;
  Ranks& ranks_;
  Clock::time_point begin_ = Clock::now();  ///< start of the time that the limit counts
  Film film_;
  SceneFingerprint fingerprint_;
  std::optional<CheckpointIdentity> identity_;  ///< empty: no checkpoints are written
  Clock::time_point last_checkpoint_ = Clock::now();
  SharedFile shared_;
  std::optional<Checkpoint> found_;
  RenderStatistics earlier_;  ///< of the checkpoint
  Training training_;
  std::string device_lost_;
  bool denoising_stopped_ = false;
  bool reached_error_ = false;  ///< max_error ended the passes
  TimeBudget budget_;
  Cryptomattes mattes_;
};

Picture Renderer::render(const Callbacks& callbacks) {
  const FlushDenormals flush;
  return Implementation::PictureRun(*implementation_, callbacks).make();
}

}  // namespace gatelight::renderer
