#include "renderer/render.h"

#include <optional>
#include <utility>

#include "renderer/ao_integrator.h"
#include "renderer/atomic_file.h"
#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/cache_report.h"
#include "renderer/checkpoint_keeper.h"
#include "renderer/render_implementation.h"
#include "renderer/sample_loop.h"

namespace gatelight::renderer {

Renderer::Renderer(const scene::Scene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

const RenderStatistics& Renderer::statistics() const {
  return implementation_->statistics;
}

CacheReport Renderer::report_cache() {
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
  Implementation& self = *implementation_;
  CacheStatistics statistics;
  self.arena.execute(
      [&] { statistics = CacheSession(*self.world, self.camera, self.region, self.options).statistics(); });
  return statistics;
}

Picture Renderer::render(const Callbacks& callbacks) {
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
  const auto keep = [&](Phase phase, const RenderStatistics& sum) {
    const CheckpointProgress progress{phase, phase == Phase::render ? sum.spp : 0, training.first_step};
    keeper->write(progress, sum, film, training.session.get(), training_of_model);
  };
  if (training.session && !training.complete) {
    const auto keep_training = [&] { keep(Phase::train, self.sum_up(0, 0.0, nullptr, training, earlier)); };
    self.train(training, callbacks, [&] {
      if (keeper && keeper->due()) keep_training();
    });
    // Training that a time limit ended is not to be repeated: where it ended is part of the picture.
    if (keeper && training.complete) keep(Phase::render, self.sum_up(0, 0.0, nullptr, training, earlier));
    if (keeper && !training.complete) keep_training();
  }
  // A picture with half a cache is for looking at, and no part of the whole one.
  const bool whole = !training.session || training.complete;
  if (training.session && whole && !cache_out.empty()) {
    write_cache_file(
        cache_out, training.session->export_state(), training.session->model(), training_of_model,
        meaning_of(options, resolve_ao_distance(options.ao_distance, self.scene.bounds)), fingerprint);
  }

  const std::unique_ptr<Pass> pass = self.make_pass(training);
  SampleLoop loop(self.arena, options, callbacks, *pass, film, options.spp);
  loop.begin_at(earlier.spp);
  if (training.stopped) loop.stop();
  const auto sum_up = [&] { return self.sum_up(loop.done(), loop.seconds(), pass.get(), training, earlier); };
  bool interrupted = false;
  while (loop.done() < options.spp) {
    loop.run_pass(options.spp);
    if (loop.done() == options.spp) break;
    if (callbacks.snapshot_wanted && callbacks.snapshot && callbacks.snapshot_wanted()) {
      statistics = sum_up();
      callbacks.snapshot(film.resolve());
    }
    if (loop.over()) {
      interrupted = true;
      break;
    }
    if (keeper && whole && keeper->due()) keep(Phase::render, sum_up());
  }

  statistics = sum_up();
  statistics.interrupted = interrupted || !whole;
  if (keeper && whole) keep(Phase::render, statistics);
  loop.report_end();
  return film.resolve();
}

}  // namespace gatelight::renderer
