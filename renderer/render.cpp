#include "renderer/render.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "renderer/cache/cache_model.h"
#include "renderer/cache/cache_session.h"
#include "renderer/cache/cached_pass.h"
#include "renderer/camera.h"
#include "renderer/film.h"
#include "renderer/memory_estimate.h"
#include "renderer/pixel_filter.h"
#include "renderer/reference_pass.h"
#include "renderer/threads.h"
#include "renderer/tiles.h"
#include "renderer/world.h"

namespace gatelight::renderer {

namespace {

using Clock = std::chrono::steady_clock;

/// A pass is as many samples as take about this long, so that time limits, signals and snapshots are served
/// soon.
constexpr double kPassSeconds = 0.7;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

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
        camera(choose_camera(scene, options.camera,
                             static_cast<float>(options.width) / static_cast<float>(options.height)),
               options.width, options.height),
        filter(options.filter, options.filter_width),
        budget(checked_budget(scene, options)) {
    const Clock::time_point start = Clock::now();
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

  std::unique_ptr<CacheSession> train(const Callbacks& callbacks);

  const scene::Scene& scene;
  RenderOptions options;
  scene::SceneRequirements requirements;
  int threads;
  tbb::global_control control;
  tbb::task_arena arena;
  PixelRect region;
  TileGrid tiles;
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
  RenderStatistics statistics;
};

std::unique_ptr<CacheSession> Renderer::Implementation::train(const Callbacks& callbacks) {
  const Clock::time_point start = Clock::now();
  const auto report = [&](Phase phase, int done, int steps, double loss) {
    if (!callbacks.progress) return;
    callbacks.progress({.phase = phase,
                        .steps_done = done,
                        .steps = steps,
                        .loss = loss,
                        .spp = options.spp,
                        .fraction = steps > 0 ? static_cast<double>(done) / steps : 0.0,
                        .seconds = seconds_since(start)});
  };
  std::unique_ptr<CacheSession> session;
  report(Phase::scout, 0, 0, 0.0);
  arena.execute([&] { session = std::make_unique<CacheSession>(*world, camera, region, options); });
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(region.width()) * static_cast<std::uint64_t>(region.height());
  statistics.cache.steps_chosen = !options.cache.train_steps;
  statistics.cache.steps_wanted = options.cache.train_steps.value_or(choose_training_steps(options, pixels));
  double reported = -1.0;
  CacheSession::Watch watch;
  watch.stop = callbacks.stop;
  watch.progress = [&](int done, int steps, double loss) {
    const double now = seconds_since(start);
    if (done < steps && now - reported < 0.1) return;
    reported = now;
    report(Phase::train, done, steps, loss);
  };
  arena.execute([&] { session->train(static_cast<std::uint64_t>(statistics.cache.steps_wanted), watch); });
  return session;
}

Renderer::Renderer(const scene::Scene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

const RenderStatistics& Renderer::statistics() const {
  return implementation_->statistics;
}

Picture Renderer::render(const Callbacks& callbacks) {
  Implementation& self = *implementation_;
  const RenderOptions& options = self.options;
  RenderStatistics& statistics = self.statistics;
  Film film(self.region, options.width, options.height, options.aovs);
  const PassContext context{self.tiles, options, self.camera, self.filter};
  std::unique_ptr<CacheSession> session;
  CachedPass* cached = nullptr;
  std::unique_ptr<Pass> pass;
  if (uses_cache(options.integrator)) {
    session = self.train(callbacks);
    auto made = std::make_unique<CachedPass>(*self.world, context, *session);
    cached = made.get();
    pass = std::move(made);
  } else {
    pass = std::make_unique<ReferencePass>(*self.world, context);
  }

  const Clock::time_point start = Clock::now();
  std::atomic<bool> stop{false};
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

  int done = 0;
  int batch = 1;
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
      statistics.spp = done;
      statistics.render_seconds = now;
      callbacks.snapshot(film.resolve());
    }
    if (done < options.spp &&
        (stop || (options.time_limit_seconds > 0.0 && now >= options.time_limit_seconds))) {
      statistics.interrupted = true;
      break;
    }
    const double per_sample = (now - pass_start) / batch;
    double budget = kPassSeconds;
    if (options.time_limit_seconds > 0.0) budget = std::min(budget, options.time_limit_seconds - now);
    batch = std::max(1, std::min(2 * batch, static_cast<int>(budget / std::max(per_sample, 1e-9))));
  }

  statistics.render_seconds = seconds_since(start);
  statistics.spp = done;
  statistics.samples = static_cast<std::uint64_t>(done) * static_cast<std::uint64_t>(self.region.width()) *
                       static_cast<std::uint64_t>(self.region.height());
  statistics.rays = pass->rays();
  if (session) {
    statistics.rays.add(session->rays());
    CacheStatistics cache = session->statistics();
    cache.steps_chosen = statistics.cache.steps_chosen;
    cache.steps_wanted = statistics.cache.steps_wanted;
    cached->add_to(cache);
    statistics.cache = std::move(cache);
  }
  SampleCounts counts = pass->counts();
  statistics.nonfinite = counts.nonfinite;
  statistics.clamped = counts.clamped;
  statistics.nonfinite_samples = std::move(counts.located);
  if (callbacks.progress)
    callbacks.progress(
        {.spp_done = done, .spp = options.spp, .fraction = 1.0, .seconds = statistics.render_seconds});
  return film.resolve();
}

}  // namespace gatelight::renderer
