#include "renderer/render.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "renderer/ao_integrator.h"
#include "renderer/atomic_file.h"
#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/cache_report.h"
#include "renderer/cache/cache_session.h"
#include "renderer/cache/cached_pass.h"
#include "renderer/camera.h"
#include "renderer/checkpoint_keeper.h"
#include "renderer/clock.h"
#include "renderer/deciding_options.h"
#include "renderer/film.h"
#include "renderer/memory_estimate.h"
#include "renderer/pixel_filter.h"
#include "renderer/reference_pass.h"
#include "renderer/threads.h"
#include "renderer/tiles.h"
#include "renderer/world.h"

namespace gatelight::renderer {

namespace {

/// A pass is as many samples as take about this long, so that time limits, signals and snapshots are served
/// soon.
constexpr double kPassSeconds = 0.7;

PixelRect resolve_region(const RenderOptions& options) {
  if (!options.region) return {0, 0, options.width, options.height};
  const auto& [x0, y0, x1, y1] = *options.region;
  if (x0 < 0 || y0 < 0 || x1 > options.width || y1 > options.height || x0 >= x1 || y0 >= y1) {
    throw BadOption(
        fmt::format("--region {},{},{},{}: expected x0,y0,x1,y1 within the picture of {}x{}, not empty", x0,
                    y0, x1, y1, options.width, options.height));
  }
  return {x0, y0, x1, y1};
}

std::size_t checked_budget(const scene::Scene& scene, const RenderOptions& options) {
  if (options.memory_limit_bytes == 0) return 0;
  const MemoryEstimate need = estimate_memory(scene, options);
  if (need.total() > options.memory_limit_bytes) {
    throw OutOfMemory(fmt::format("{}: rendering needs about {} MiB, more than the limit of {} MiB",
                                  scene.path, need.total() >> 20, options.memory_limit_bytes >> 20));
  }
  return options.memory_limit_bytes - (need.total() - need.bvh);
}

/// A cache on its way. Without a session for integrators that have none.
struct Training {
  std::unique_ptr<CacheSession> session;
  std::uint64_t first_step = 0;  ///< those of a loaded cache come before
  int steps = 0;                 ///< wanted
  bool chosen = false;           ///< by the picture's pixels and samples
  bool complete = false;
  bool stopped = false;  ///< by the caller
};

}  // namespace

struct Renderer::Implementation {
  Implementation(const scene::Scene& scene_in, const RenderOptions& options_in)
      : scene(scene_in),
        options(options_in),
        requirements(scene::compute_requirements(scene_in)),
        threads(options.threads > 0 ? options.threads : available_threads()),
        control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
        arena(threads),
        region(resolve_region(options)),
        tiles(region),
        view(choose_camera(scene, options.camera,
                           static_cast<float>(options.width) / static_cast<float>(options.height))),
        camera(view, options.width, options.height),
        filter(options.filter, options.filter_width),
        budget(checked_budget(scene, options)) {
    const Clock::time_point start = Clock::now();
    // What was loaded has learned enough, unless the caller says otherwise.
    if (!options.cache.train_steps && options.cache.cache_in.empty()) {
      steps_chosen = true;
      options.cache.train_steps = choose_training_steps(
          options, static_cast<std::uint64_t>(region.width()) * static_cast<std::uint64_t>(region.height()));
    }
    arena.execute([&] {
      textures.emplace(scene);
      environment.emplace(options.environment);
      coverage.emplace(scene, *textures);
      surfaces.emplace(scene, *textures);
      accel.emplace(scene, *coverage, AccelOptions{threads, options.isa, budget});
      lights.emplace(scene, *textures, *environment, options.light_selection);
    });
    world.emplace(World{scene, requirements, *textures, *surfaces, *accel, *environment, *lights});
    statistics.build_seconds = seconds_since(start);
    statistics.width = region.width();
    statistics.height = region.height();
    statistics.threads = threads;
    statistics.isa = accel->isa();
    statistics.geometry_bytes = scene::geometry_bytes(scene);
    statistics.bvh_bytes = accel->bytes();
    statistics.texture_bytes = textures->bytes() + environment->bytes();
    statistics.light_bytes = lights->bytes();
  }

  CheckpointIdentity identity(const SceneFingerprint& fingerprint) const;
  /// In the state of the checkpoint or of the cache file where there is one; new otherwise.
  Training begin_training(Checkpoint* found, const SceneFingerprint& fingerprint, const Callbacks& callbacks);
  void train(Training& training, const Callbacks& callbacks, const std::function<void()>& after_group);
  /// Of this run and those before it.
  RenderStatistics sum_up(int spp, double seconds, const Pass* pass, const Training& training,
                          const RenderStatistics& earlier) const;

  const scene::Scene& scene;
  RenderOptions options;
  scene::SceneRequirements requirements;
  int threads;
  tbb::global_control control;
  tbb::task_arena arena;
  PixelRect region;
  TileGrid tiles;
  scene::Camera view;
  Camera camera;
  FilterSampler filter;
  std::size_t budget;
  std::optional<Textures> textures;
  std::optional<Environment> environment;
  std::optional<Coverage> coverage;
  std::optional<Surfaces> surfaces;
  std::optional<Accel> accel;
  std::optional<Lights> lights;
  std::optional<World> world;
  bool steps_chosen = false;  ///< of training, by the picture's pixels and samples
  RenderStatistics statistics;
};

CheckpointIdentity Renderer::Implementation::identity(const SceneFingerprint& fingerprint) const {
  NamedTexts machine = {{"isa", accel->isa()}};
  if (uses_cache(options.integrator)) machine.push_back({"kernels", cache_machine(options)});
  return {deciding_options(options, view, machine), fingerprint, scene.instances.size()};
}

Training Renderer::Implementation::begin_training(Checkpoint* found, const SceneFingerprint& fingerprint,
                                                  const Callbacks& callbacks) {
  Training training;
  const std::string& file = options.cache.cache_in;
  const auto make_session = [&](const CacheSetup* setup) {
    if (!setup && callbacks.progress) callbacks.progress({.phase = Phase::scout, .spp = options.spp});
    arena.execute(
        [&] { training.session = std::make_unique<CacheSession>(*world, camera, region, options, setup); });
  };
  if (found) {
    make_session(&found->cache_setup());
    training.session->import_state(found->read_cache(training.session->model(), training_options(options)));
    training.first_step = found->progress().first_step;
  } else if (!file.empty()) {
    CacheFile cache(file);
    cache.expect(meaning_of(options, resolve_ao_distance(options.ao_distance, scene.bounds)), fingerprint,
                 scene.instances.size());
    make_session(&cache.setup());
    training.session->import_state(cache.read_state(training.session->model(), training_options(options)));
    training.first_step = training.session->steps();
  } else {
    make_session(nullptr);
  }
  training.chosen = steps_chosen;
  training.steps = options.cache.train_steps.value_or(0);
  training.complete = found && found->progress().phase == Phase::render;
  return training;
}

void Renderer::Implementation::train(Training& training, const Callbacks& callbacks,
                                     const std::function<void()>& after_group) {
  const Clock::time_point start = Clock::now();
  const auto first = static_cast<int>(training.first_step);
  double reported = -1.0;
  CacheSession::Watch watch;
  watch.stop = [&] { return training.stopped = callbacks.stop && callbacks.stop(); };
  watch.after_group = after_group;
  watch.progress = [&](int done, int steps, double loss) {
    const double now = seconds_since(start);
    if (!callbacks.progress || (done < steps && now - reported < 0.1)) return;
    reported = now;
    callbacks.progress({.phase = Phase::train,
                        .steps_done = done - first,
                        .steps = steps - first,
                        .loss = loss,
                        .spp = options.spp,
                        .fraction = static_cast<double>(done - first) / (steps - first),
                        .seconds = now});
  };
  const std::uint64_t end = training.first_step + static_cast<std::uint64_t>(training.steps);
  arena.execute([&] { training.session->train(end, watch); });
  training.complete = !training.stopped || training.session->steps() >= end;
}

RenderStatistics Renderer::Implementation::sum_up(int spp, double seconds, const Pass* pass,
                                                  const Training& training,
                                                  const RenderStatistics& earlier) const {
  RenderStatistics sum = statistics;
  sum.render_seconds = seconds;
  sum.spp = spp;
  sum.samples = static_cast<std::uint64_t>(spp) * static_cast<std::uint64_t>(region.width()) *
                static_cast<std::uint64_t>(region.height());
  SampleCounts counts = pass ? pass->counts() : SampleCounts{};
  sum.rays = pass ? pass->rays() : RayCounts{};
  sum.nonfinite = counts.nonfinite;
  sum.clamped = counts.clamped;
  sum.nonfinite_samples = std::move(counts.located);
  if (training.session) {
    sum.rays.add(training.session->rays());
    sum.cache = training.session->statistics();
    sum.cache.steps_chosen = training.chosen;
    sum.cache.steps_wanted = training.steps;
    if (const auto* cached = dynamic_cast<const CachedPass*>(pass)) cached->add_to(sum.cache);
  }
  add_earlier(sum, earlier);
  return sum;
}

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

Picture Renderer::render(const Callbacks& callbacks) {
  Implementation& self = *implementation_;
  const RenderOptions& options = self.options;
  RenderStatistics& statistics = self.statistics;
  Film film(self.region, options.width, options.height, options.aovs);
  const PassContext context{self.tiles, options, self.camera, self.filter};

  SceneFingerprint fingerprint;
  const std::string& cache_out = options.cache.cache_out;
  const bool keeps = !options.checkpoint.file.empty();
  const bool caches = uses_cache(options.integrator);
  if (caches && !cache_out.empty()) check_writable(cache_out);
  if (keeps || (caches && !(options.cache.cache_in.empty() && cache_out.empty())))
    self.arena.execute([&] { fingerprint = compute_scene_fingerprint(self.scene, options.environment); });
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
  std::unique_ptr<Pass> pass;
  if (training.session) {
    pass = std::make_unique<CachedPass>(*self.world, context, *training.session);
  } else {
    pass = std::make_unique<ReferencePass>(*self.world, context);
  }

  const Clock::time_point start = Clock::now();
  std::atomic<bool> stop{training.stopped};
  std::mutex progress_mutex;
  double last_progress = -1.0;
  const auto report = [&](int done, double of_pass, int pass_spp) {
    if (!callbacks.progress) return;
    const std::unique_lock lock(progress_mutex, std::try_to_lock);
    const double now = seconds_since(start);
    if (!lock || now - last_progress < 0.1) return;
    last_progress = now;
    callbacks.progress({.spp_done = done,
                        .spp = options.spp,
                        .fraction = (done + of_pass * pass_spp) / options.spp,
                        .seconds = now});
  };

  const auto sum_up = [&](int spp, double seconds) {
    return self.sum_up(spp, seconds, pass.get(), training, earlier);
  };
  int done = earlier.spp;
  int batch = 1;
  bool interrupted = false;
  while (done < options.spp) {
    batch = std::min(batch, options.spp - done);
    const double pass_start = seconds_since(start);
    self.arena.execute([&] {
      pass->run(static_cast<std::uint32_t>(done), static_cast<std::uint32_t>(done + batch), film,
                [&](double fraction) {
                  if (callbacks.stop && callbacks.stop()) stop = true;
                  report(done, fraction, batch);
                });
    });
    done += batch;
    const double now = seconds_since(start);
    if (options.nan_policy == NanPolicy::error) {
      const std::vector<NonFiniteSample> located = pass->counts().located;
      if (!located.empty()) {
        throw NumericalError(fmt::format("sample {} of pixel {},{} (seed {}) is not finite",
                                         located[0].sample, located[0].x, located[0].y, located[0].seed));
      }
    }
    if (callbacks.snapshot_wanted && callbacks.snapshot && done < options.spp &&
        callbacks.snapshot_wanted()) {
      statistics = sum_up(done, now);
      callbacks.snapshot(film.resolve());
    }
    if (done < options.spp &&
        (stop || (options.time_limit_seconds > 0.0 && now >= options.time_limit_seconds))) {
      interrupted = true;
      break;
    }
    if (keeper && whole && done < options.spp && keeper->due()) keep(Phase::render, sum_up(done, now));
    const double per_sample = (now - pass_start) / batch;
    double budget = kPassSeconds;
    if (options.time_limit_seconds > 0.0) budget = std::min(budget, options.time_limit_seconds - now);
    batch = std::max(1, std::min(2 * batch, static_cast<int>(budget / std::max(per_sample, 1e-9))));
  }

  statistics = sum_up(done, seconds_since(start));
  statistics.interrupted = interrupted || !whole;
  if (keeper && whole) keep(Phase::render, statistics);
  if (callbacks.progress)
    callbacks.progress(
        {.spp_done = done, .spp = options.spp, .fraction = 1.0, .seconds = seconds_since(start)});
  return film.resolve();
}

}  // namespace gatelight::renderer
