// The whole path tracer and its limits on real scenes. render/path is the path tracer, render/tracing_only
// only traces. replay/{camera,bounce,shadow}/{single,packet16,fast} traces the recorded rays of render/path
// again; fast: packets in a scene that is not watertight.
// Counters are per second on the threads of the run.

#include <benchmark/benchmark.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <string>

#include "bench/tracing_only.h"
#include "bench/world_fixture.h"

namespace gatelight::bench {
namespace {

using Tiles = std::vector<std::vector<renderer::CameraSample>>;

constexpr double kSamples = kWidth * kHeight;

/// Runs body(i) for all i < count on that many threads.
template <typename Body>
void for_each(std::size_t count, int threads, Body&& body) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute(
      [&] { tbb::parallel_for(std::size_t{0}, count, body, tbb::simple_partitioner()); });
}

struct Worker {
  std::vector<renderer::SampleResult> results;
  renderer::PathIntegrator::Scratch scratch;
  renderer::RayCounts rays;
};

using benchmark::Counter;

void set_rates(benchmark::State& state, std::uint64_t rays) {
  state.counters["samples/s"] = Counter(kSamples, Counter::kIsIterationInvariantRate);
  state.counters["rays/s"] = Counter(static_cast<double>(rays), Counter::kIsRate);
  state.counters["rays/sample"] = Counter(static_cast<double>(rays) / kSamples, Counter::kAvgIterations);
}

void render_path(benchmark::State& state, const SceneCase& which) {
  const WorldFixture* w = world(which);
  if (!w) return state.SkipWithError(kNoScene);
  const renderer::PathIntegrator integrator(w->world, path_integrator_options(w->options));
  const int threads = static_cast<int>(state.range(0));
  tbb::enumerable_thread_specific<Worker> workers;
  std::uint32_t pass = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const Tiles tiles = w->tiles(pass++);
    state.ResumeTiming();
    for_each(tiles.size(), threads, [&](std::size_t i) {
      Worker& worker = workers.local();
      worker.results.resize(tiles[i].size());
      integrator.trace(tiles[i], worker.results, {}, worker.rays, worker.scratch);
    });
  }
  std::uint64_t rays = 0;
  double embree = 0.0;
  for (const Worker& worker : workers) {
    rays += worker.rays.camera + worker.rays.bounce + worker.rays.shadow;
    embree += worker.rays.seconds;
  }
  set_rates(state, rays);
  state.counters["Mray/s_in_embree"] = static_cast<double>(rays) / embree * threads * 1e-6;
}

void render_tracing_only(benchmark::State& state, const SceneCase& which) {
  const WorldFixture* w = world(which);
  if (!w) return state.SkipWithError(kNoScene);
  const TracingOnly tracer(*w);
  std::atomic<std::uint64_t> rays{0};
  std::uint32_t pass = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const Tiles tiles = w->tiles(pass++);
    state.ResumeTiming();
    for_each(tiles.size(), static_cast<int>(state.range(0)),
             [&](std::size_t i) { rays += tracer.trace(tiles[i]); });
  }
  set_rates(state, rays);
}

const renderer::RayLog& recorded(const WorldFixture& w, const std::string& name) {
  static std::map<std::string, renderer::RayLog> cache;
  auto [found, inserted] = cache.try_emplace(name);
  if (inserted) {
    const renderer::PathIntegrator integrator(w.world, path_integrator_options(w.options));
    Worker worker;
    worker.scratch.log = &found->second;
    for (const std::vector<renderer::CameraSample>& tile : w.tiles(0)) {
      worker.results.resize(tile.size());
      integrator.trace(tile, worker.results, {}, worker.rays, worker.scratch);
    }
  }
  return found->second;
}

void replay(benchmark::State& state, const SceneCase& which,
            std::vector<renderer::Ray> renderer::RayLog::*kind, bool packets, Watertight watertight) {
  const WorldFixture* w = world(which);
  if (!w) return state.SkipWithError(kNoScene);
  const std::vector<renderer::Ray>& rays = recorded(*w, which.name).*kind;
  const BareEmbree& bare = w->bare(watertight);
  const bool shadow = kind == &renderer::RayLog::shadow;
  const bool camera = kind == &renderer::RayLog::camera;
  constexpr std::size_t kChunk = 4096;
  for (auto _ : state) {
    for_each((rays.size() + kChunk - 1) / kChunk, static_cast<int>(state.range(0)), [&](std::size_t i) {
      const std::span chunk = std::span(rays).subspan(i * kChunk);
      const std::span part = chunk.first(std::min(kChunk, chunk.size()));
      if (packets) {
        bare.trace_packets(part, shadow, camera);
      } else {
        bare.trace_single(part, shadow);
      }
    });
  }
  state.counters["rays/s"] = Counter(static_cast<double>(rays.size()), Counter::kIsIterationInvariantRate);
}

const int render_registered = [] {
  using Log = renderer::RayLog;
  for (const SceneCase* which : {&kKitchen, &kSalle, &kBistro, &kLiving, &kSponza}) {
    const std::string scene = which->name;
    const auto add = [&](const std::string& name, auto&& function) {
      benchmark::RegisterBenchmark((name + "/" + scene).c_str(), function)
          ->ArgName("threads")
          ->Arg(1)
          ->Arg(2)
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
    };
    add("render/path", [which](benchmark::State& s) { render_path(s, *which); });
    add("render/tracing_only", [which](benchmark::State& s) { render_tracing_only(s, *which); });
    const std::pair<const char*, std::vector<renderer::Ray> Log::*> kinds[] = {
        {"camera", &Log::camera}, {"bounce", &Log::bounce}, {"shadow", &Log::shadow}};
    for (const auto& [kind, member] : kinds) {
      for (const std::string way : {"/single", "/packet16", "/fast"}) {
        add(std::string("replay/") + kind + way, [which, rays = member, way](benchmark::State& s) {
          replay(s, *which, rays, way != "/single", way == "/fast" ? Watertight::fast : Watertight::robust);
        });
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace gatelight::bench
