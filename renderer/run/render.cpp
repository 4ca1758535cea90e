#include "renderer/render.h"

#include <new>
#include <optional>
#include <utility>

#include "neural/base/errors.h"
#include "neural/base/flush_denormals.h"
#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/cache_report.h"
#include "renderer/machine/atomic_file.h"
#include "renderer/run/checkpoint_keeper.h"
#include "renderer/run/implementation.h"
#include "renderer/run/sample_loop.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// A full disk, or too little memory for a copy of the state, is to cost a file but not the picture.
void try_writing(const Callbacks& callbacks, bool again, const std::function<void()>& write) {
  if (!callbacks.output_failed) return write();
  try {
    write();
  } catch (const OutputError&) {
    callbacks.output_failed(std::current_exception(), again);
  } catch (const std::bad_alloc&) {
    callbacks.output_failed(std::current_exception(), again);
  }
}

}  // namespace

Renderer::Renderer(const scene::Scene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

const RenderStatistics& Renderer::statistics() const {
  return implementation_->statistics;
}

CacheReport Renderer::report_cache() {
  const neural::FlushDenormals flush;
  Implementation& self = *implementation_;
  CacheReport report;
  self.arena.execute(
      [&] { report = renderer::report_cache(*self.world, self.camera, self.region, self.options); });
  RenderStatistics statistics = self.statistics;
  statistics.cache = std::move(report.statistics.cache);
  report.statistics = std::move(statistics);
  return report;
}

CacheStatistics Renderer::set_up_cache() {
  const neural::FlushDenormals flush;
  Implementation& self = *implementation_;
  CacheStatistics statistics;
  self.arena.execute(
      [&] { statistics = CacheSession(*self.world, self.camera, self.region, self.options).statistics(); });
  return statistics;
}

Picture Renderer::render(const Callbacks& callbacks) {
  const neural::FlushDenormals flush;
  Implementation& self = *implementation_;
  const RenderOptions& options = self.options;
  RenderStatistics& statistics = self.statistics;
  Film film(self.region, options.width, options.height, options.aovs);

  SceneFingerprint fingerprint;
  const std::string& cache_out = options.cache.cache_out;
  const bool keeps = !options.checkpoint.file.empty();
  const bool caches = uses_cache(options.integrator);
  if (caches && !cache_out.empty()) check_writable(cache_out);
  if (keeps || (caches && !(options.cache.cache_in.empty() && cache_out.empty())))
    fingerprint = self.scene_fingerprint();
  std::optional<CheckpointKeeper> keeper;
  std::optional<Checkpoint> found;
  RenderStatistics earlier;
  if (keeps) {
    keeper.emplace(options.checkpoint, self.identity(fingerprint));
    found = keeper->find(options.spp);
  }
  if (found) found->restore(film, earlier);

  Training training;
  if (caches) training = self.begin_training(found ? &*found : nullptr, fingerprint, callbacks);
  const neural::TrainingOptions training_of_model = training_options(options);
  const auto keep = [&](Phase phase, const RenderStatistics& sum, bool again) {
    const CheckpointProgress progress{phase, phase == Phase::render ? sum.spp : 0, training.first_step};
    try_writing(callbacks, again,
                [&] { keeper->write(progress, sum, film, training.session.get(), training_of_model); });
  };
  if (training.session && !training.complete) {
    const auto keep_training = [&](bool again) {
      keep(Phase::train, self.sum_up(0, 0.0, nullptr, training, earlier), again);
    };
    const auto after_group = [&] {
      if (!keeper || !keeper->due()) return;
      training.session->settle();
      keep_training(true);
    };
    try {
      self.train(training, callbacks, after_group);
    } catch (const TrainingDiverged& error) {
      // A picture and a cache file of the last good state are worth more than none. The checkpoint stays.
      if (!self.return_to_good(training, found ? &*found : nullptr, earlier, callbacks)) throw;
      training.diverged = error.what();
      keeper.reset();
    }
    // Training that a time limit ended is not to be repeated: where it ended is part of the picture.
    if (keeper && training.complete) {
      keep(Phase::render, self.sum_up(0, 0.0, nullptr, training, earlier), true);
    }
    if (keeper && !training.complete) keep_training(false);
  }
  // A picture with half a cache is for looking at, and no part of the whole one.
  const bool whole = !training.session || training.complete;
  if (training.session && whole && !cache_out.empty()) {
    try_writing(callbacks, false, [&] {
      write_cache_file(
          cache_out, training.session->export_state(), training.session->model(), training_of_model,
          meaning_of(options, resolve_ao_distance(options.ao_distance, self.scene.bounds)), fingerprint);
    });
  }

  const std::unique_ptr<Pass> pass = self.make_pass(training);
  SampleLoop loop(self.arena, options, callbacks, *pass, film, options.spp);
  loop.begin_at(earlier.spp);
  if (training.stopped) loop.stop();
  const auto sum_up = [&] { return self.sum_up(loop.done(), loop.seconds(), pass.get(), training, earlier); };
  bool interrupted = false;
  std::string device_lost;
  while (loop.done() < options.spp) {
    try {
      loop.run_pass(options.spp);
    } catch (const neural::DeviceLost& error) {
      // Every pixel is the mean of its own samples: the part of a pass that was made is a picture, but none
      // that a checkpoint could go on from. The last one stays.
      if (loop.done() == 0) throw;
      device_lost = error.what();
      interrupted = true;
      break;
    }
    if (loop.done() == options.spp) break;
    if (callbacks.snapshot_wanted && callbacks.snapshot && callbacks.snapshot_wanted()) {
      statistics = sum_up();
      callbacks.snapshot(film.resolve());
    }
    if (loop.over()) {
      interrupted = true;
      break;
    }
    if (keeper && whole && keeper->due()) keep(Phase::render, sum_up(), true);
  }

  statistics = sum_up();
  statistics.interrupted = interrupted || !whole;
  statistics.device_lost = device_lost;
  if (keeper && whole && device_lost.empty()) keep(Phase::render, statistics, false);
  loop.report_end();
  return film.resolve();
}

}  // namespace gatelight::renderer
