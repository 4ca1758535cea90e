// Renderer::render: one picture from start to end.

#include <filesystem>
#include <functional>
#include <new>
#include <optional>
#include <string>

#include "neural/base/errors.h"
#include "neural/base/flush_denormals.h"
#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/machine/atomic_file.h"
#include "renderer/machine/clock.h"
#include "renderer/run/finished_picture.h"
#include "renderer/run/implementation.h"
#include "renderer/run/sample_loop.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

class Renderer::Implementation::PictureRun {
 public:
  PictureRun(Implementation& renderer, const Callbacks& callbacks)
      : renderer_(renderer),
        options_(renderer.options),
        callbacks_(callbacks),
        film_(renderer.region, options_.width, options_.height, film_aovs(options_)) {}

  Picture make() {
    restore();
    train();
    write_cache();
    const std::unique_ptr<Pass> pass = renderer_.make_pass(training_);
    SampleLoop loop(renderer_.arena, options_, callbacks_, *pass, film_, options_.spp);
    run_passes(loop, *pass);
    end(loop, *pass);
    return finished();
  }

 private:
  void restore() {
    const CacheOptions& cache = options_.cache;
    const bool keeps = !options_.checkpoint.file.empty();
    const bool caches = uses_cache(options_.integrator);
    if (caches && !cache.cache_out.empty()) check_writable(cache.cache_out);
    if (keeps || (caches && !(cache.cache_in.empty() && cache.cache_out.empty())))
      fingerprint_ = renderer_.scene_fingerprint();
    if (!keeps) return;
    const std::string& file = options_.checkpoint.file;
    identity_ = renderer_.identity(fingerprint_);
    check_writable(file);
    if (!options_.checkpoint.resume || !std::filesystem::exists(file)) return;
    found_.emplace(file);
    found_->expect(*identity_, options_.spp);
    found_->restore(film_, earlier_);
  }

  void train() {
    if (!uses_cache(options_.integrator)) return;
    training_ = renderer_.begin_training(found(), fingerprint_, callbacks_);
    if (training_.complete) return;
    try {
      renderer_.train(training_, callbacks_, [&] {
        if (!checkpoint_due()) return;
        training_.session->settle();
        keep(Phase::train, sum_up(), true);
      });
    } catch (const TrainingDiverged& error) {
      // The last good state still gives a picture and a cache file. The checkpoint is kept.
      if (!renderer_.return_to_good(training_, found(), earlier_, callbacks_)) throw;
      training_.diverged = error.what();
      identity_.reset();
    }
    // Training that a time limit ended is not repeated: its end decides the picture.
    keep(whole() ? Phase::render : Phase::train, sum_up(), whole());
  }

  void write_cache() const {
    if (!training_.session || !whole() || options_.cache.cache_out.empty()) return;
    try_writing(false, [&] {
      write_cache_file(options_.cache.cache_out, training_.session->export_state(),
                       training_.session->model(), training_options(options_),
                       {options_, resolve_ao_distance(options_.ao_distance, renderer_.scene.bounds)},
                       fingerprint_);
    });
  }

  void run_passes(SampleLoop& loop, const Pass& pass) {
    loop.begin_at(earlier_.spp);
    if (training_.stopped) loop.stop();
    while (loop.done() < options_.spp) {
      try {
        loop.run_pass(options_.spp);
      } catch (const neural::DeviceLost& error) {
        // Each pixel is the mean of its own samples, so an incomplete pass is a picture. A checkpoint could
        // not resume from it; the last checkpoint is kept.
        if (loop.done() == 0) throw;
        device_lost_ = error.what();
        return;
      }
      if (loop.done() == options_.spp) return;
      if (callbacks_.snapshot_wanted && callbacks_.snapshot && callbacks_.snapshot_wanted()) {
        renderer_.statistics = sum_up(loop, pass);
        callbacks_.snapshot(finished());
      }
      if (loop.over()) return;
      if (whole() && checkpoint_due()) keep(Phase::render, sum_up(loop, pass), true);
    }
  }

  void end(const SampleLoop& loop, const Pass& pass) {
    RenderStatistics& statistics = renderer_.statistics;
    statistics = sum_up(loop, pass);
    statistics.interrupted = loop.done() < options_.spp || !whole();
    statistics.device_lost = device_lost_;
    if (whole() && device_lost_.empty()) keep(Phase::render, statistics, false);
    loop.report_end();
  }

  /// The picture of the film, with its statistics.
  Picture finished() {
    FinishedPicture finished = finished_picture(film_, options_, renderer_.arena);
    renderer_.statistics.reconstruct_seconds = finished.reconstruct_seconds;
    renderer_.statistics.estimated_error = finished.estimated_error;
    return std::move(finished.picture);
  }
  Checkpoint* found() { return found_ ? &*found_ : nullptr; }
  /// A picture from an incomplete cache is a preview; it is never resumed.
  bool whole() const { return !training_.session || training_.complete; }
  /// Statistics before the first pass.
  RenderStatistics sum_up() const { return renderer_.sum_up(0, 0.0, nullptr, training_, earlier_); }
  RenderStatistics sum_up(const SampleLoop& loop, const Pass& pass) const {
    return renderer_.sum_up(loop.done(), loop.seconds(), &pass, training_, earlier_);
  }
  bool checkpoint_due() const {
    return identity_ && seconds_since(last_checkpoint_) >= options_.checkpoint.every_seconds;
  }
  /// Writes a checkpoint where one is wanted. `again`: another one will be tried.
  void keep(Phase phase, const RenderStatistics& sum, bool again) {
    if (!identity_) return;
    const CheckpointProgress progress{phase, phase == Phase::render ? sum.spp : 0, training_.first_step};
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
  Film film_;
  SceneFingerprint fingerprint_;
  std::optional<CheckpointIdentity> identity_;  ///< empty: no checkpoints are written
  Clock::time_point last_checkpoint_ = Clock::now();
  std::optional<Checkpoint> found_;
  RenderStatistics earlier_;  ///< of the checkpoint
  Training training_;
  std::string device_lost_;
};

Picture Renderer::render(const Callbacks& callbacks) {
  const neural::FlushDenormals flush;
  return Implementation::PictureRun(*implementation_, callbacks).make();
}

}  // namespace gatelight::renderer
