#include "renderer/render.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <tuple>

#include "renderer/ao_integrator.h"
#include "renderer/camera.h"
#include "renderer/film.h"
#include "renderer/memory_estimate.h"
#include "renderer/path_integrator.h"
#include "renderer/pixel_filter.h"
#include "renderer/threads.h"
#include "renderer/world.h"

namespace gatelight::renderer {

namespace {

using Clock = std::chrono::steady_clock;

/// Pixels of a tile's side. The camera rays of a tile, one a pixel, are traced as one batch: at depth four
/// there are still enough of them to fill packets of 16, and their paths (200 bytes each) stay in the
/// second-level cache.
constexpr int kTile = 16;

/// A pass is as many samples as take about this long, so that time limits, signals and snapshots are served
/// soon.
constexpr double kPassSeconds = 0.7;

constexpr std::size_t kNonFiniteKept = 16;

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

/// Morton order within a tile keeps packets of 16 rays square.
struct TileOrder {
  std::array<std::uint8_t, kTile * kTile> x{};
  std::array<std::uint8_t, kTile * kTile> y{};
};
constexpr TileOrder kTileOrder = [] {
  TileOrder order;
  for (unsigned i = 0; i < kTile * kTile; ++i) {
    unsigned x = 0;
    unsigned y = 0;
    for (unsigned bit = 0; bit < 4; ++bit) {
      x |= (i >> (2 * bit) & 1u) << bit;
      y |= (i >> (2 * bit + 1) & 1u) << bit;
    }
    order.x[i] = static_cast<std::uint8_t>(x);
    order.y[i] = static_cast<std::uint8_t>(y);
  }
  return order;
}();

/// What one thread needs to trace a tile.
struct Worker {
  std::vector<CameraSample> samples;
  std::vector<SampleResult> results;
  std::vector<FirstHit> first_hits;
  PathIntegrator::Scratch path;
  AoIntegrator::Scratch ao;
  RayCounts rays;
  std::uint64_t nonfinite = 0;
  std::uint64_t clamped = 0;
  std::vector<NonFiniteSample> located;
};

void keep_first(std::vector<NonFiniteSample>& samples) {
  std::sort(samples.begin(), samples.end(), [](const NonFiniteSample& a, const NonFiniteSample& b) {
    return std::tie(a.y, a.x, a.sample) < std::tie(b.y, b.x, b.sample);
  });
  if (samples.size() > kNonFiniteKept) samples.resize(kNonFiniteKept);
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
    path.emplace(*world, options);
    ao.emplace(*world, resolve_ao_distance(options.ao_distance, scene.bounds));
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

  void render_tile(int tile_x, int tile_y, std::uint32_t first_sample, std::uint32_t end_sample, Film& film,
                   Worker& worker) const;

  const scene::Scene& scene;
  RenderOptions options;
  scene::SceneRequirements requirements;
  int threads;
  tbb::global_control control;
  tbb::task_arena arena;
  PixelRect region;
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
  std::optional<PathIntegrator> path;
  std::optional<AoIntegrator> ao;
  RenderStatistics statistics;
};

void Renderer::Implementation::render_tile(int tile_x, int tile_y, std::uint32_t first_sample,
                                           std::uint32_t end_sample, Film& film, Worker& worker) const {
  for (std::uint32_t sample = first_sample; sample < end_sample; ++sample) {
    worker.samples.clear();
    for (std::size_t i = 0; i < kTile * kTile; ++i) {
      const int x = tile_x * kTile + kTileOrder.x[i];
      const int y = tile_y * kTile + kTileOrder.y[i];
      if (x < region.x0 || x >= region.x1 || y < region.y0 || y >= region.y1) continue;
      const auto ux = static_cast<std::uint32_t>(x);
      const auto uy = static_cast<std::uint32_t>(y);
      CameraSample s;
      s.sampler = Sampler(options.sampler, options.seed, ux, uy, sample);
      s.seed = hash(hash(hash(hash(options.seed) + ux) + uy) + sample);
      const scene::Vec2 offset = filter.sample(s.sampler.get_2d(dimension::kFilm));
      s.camera_ray =
          camera.ray(static_cast<float>(x) + 0.5f + offset.x(), static_cast<float>(y) + 0.5f + offset.y());
      worker.samples.push_back(s);
    }
    worker.results.resize(worker.samples.size());
    if (film.needs_first_hits()) worker.first_hits.resize(worker.samples.size());
    if (options.integrator == Integrator::path) {
      path->trace(worker.samples, worker.results, worker.first_hits, worker.rays, worker.path);
    } else {
      ao->trace(worker.samples, worker.results, worker.first_hits, worker.rays, worker.ao);
    }
    std::size_t i = 0;
    for (std::size_t k = 0; k < kTile * kTile; ++k) {
      const int x = tile_x * kTile + kTileOrder.x[k];
      const int y = tile_y * kTile + kTileOrder.y[k];
      if (x < region.x0 || x >= region.x1 || y < region.y0 || y >= region.y1) continue;
      Color radiance = worker.results[i].radiance;
      if (film.needs_first_hits()) film.add(x, y, worker.first_hits[i]);
      ++i;
      if (!radiance.isFinite().all()) {
        ++worker.nonfinite;
        worker.located.push_back({x, y, sample, options.seed});
        if (worker.located.size() > 16 * kNonFiniteKept) keep_first(worker.located);
        continue;
      }
      if (options.clamp > 0.0f) {
        const float l = scene::luminance(radiance);
        if (l > options.clamp) {
          radiance *= options.clamp / l;
          ++worker.clamped;
        }
      }
      film.add(x, y, radiance);
    }
  }
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
  tbb::enumerable_thread_specific<Worker> workers;

  // Tiles lie on the grid of the full picture, so that a region sees the same batches as the whole.
  const int first_x = self.region.x0 / kTile;
  const int first_y = self.region.y0 / kTile;
  const int tiles_x = (self.region.x1 + kTile - 1) / kTile - first_x;
  const int tiles_y = (self.region.y1 + kTile - 1) / kTile - first_y;
  const int tiles = tiles_x * tiles_y;

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
  int pass = 1;
  while (done < options.spp) {
    pass = std::min(pass, options.spp - done);
    const double pass_start = seconds_since(start);
    std::atomic<int> finished{0};
    self.arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<int>(0, tiles, 1),
          [&](const tbb::blocked_range<int>& range) {
            Worker& worker = workers.local();
            for (int t = range.begin(); t < range.end(); ++t) {
              self.render_tile(first_x + t % tiles_x, first_y + t / tiles_x, static_cast<std::uint32_t>(done),
                               static_cast<std::uint32_t>(done + pass), film, worker);
              if (callbacks.stop && callbacks.stop()) stop = true;
              report(done, static_cast<double>(++finished) / tiles, pass);
            }
          },
          tbb::simple_partitioner());
    });
    done += pass;
    const double now = seconds_since(start);
    if (options.nan_policy == NanPolicy::error) {
      std::vector<NonFiniteSample> located;
      for (Worker& w : workers) located.insert(located.end(), w.located.begin(), w.located.end());
      keep_first(located);
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
    const double per_sample = (now - pass_start) / pass;
    double budget = kPassSeconds;
    if (options.time_limit_seconds > 0.0) budget = std::min(budget, options.time_limit_seconds - now);
    pass = std::max(1, std::min(2 * pass, static_cast<int>(budget / std::max(per_sample, 1e-9))));
  }

  statistics.render_seconds = seconds_since(start);
  statistics.spp = done;
  statistics.samples = static_cast<std::uint64_t>(done) * static_cast<std::uint64_t>(self.region.width()) *
                       static_cast<std::uint64_t>(self.region.height());
  statistics.rays = {};
  statistics.nonfinite = 0;
  statistics.clamped = 0;
  statistics.nonfinite_samples.clear();
  for (const Worker& w : workers) {
    statistics.rays.camera += w.rays.camera;
    statistics.rays.bounce += w.rays.bounce;
    statistics.rays.shadow += w.rays.shadow;
    statistics.rays.seconds += w.rays.seconds;
    statistics.nonfinite += w.nonfinite;
    statistics.clamped += w.clamped;
    statistics.nonfinite_samples.insert(statistics.nonfinite_samples.end(), w.located.begin(),
                                        w.located.end());
  }
  keep_first(statistics.nonfinite_samples);
  if (callbacks.progress)
    callbacks.progress(
        {.spp_done = done, .spp = options.spp, .fraction = 1.0, .seconds = statistics.render_seconds});
  return film.resolve();
}

}  // namespace gatelight::renderer
