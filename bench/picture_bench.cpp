// picture/SCENE/{paths,denoised,bare,preview,standard,final}/threads:N: whole pictures of 960x540, as
// gatelight render makes them. Counters are the seconds of their phases. With --schedule=FILE the last
// picture's loops and tasks are recorded, for scripts/measure/model-cores.

#include <benchmark/benchmark.h>

#include <memory>
#include <optional>
#include <string>

#include "base/parallel/schedule.h"
#include "bench/schedule_file.h"
#include "bench/world_fixture.h"
#include "renderer/render.h"
#include "renderer/settings/presets.h"
#include "scene/gltf.h"

namespace gatelight::bench {
namespace {

constexpr int kPictureWidth = 960, kPictureHeight = 540;

struct Kind {
  const char* name;
  std::optional<renderer::CachePreset> preset;  ///< none: paths
  bool denoised = false;                        ///< of paths
};
constexpr Kind kKinds[] = {{"paths", {}},
                           {"denoised", {}, true},
                           {"bare", renderer::CachePreset::bare},
                           {"preview", renderer::CachePreset::preview},
                           {"standard", renderer::CachePreset::standard},
                           {"final", renderer::CachePreset::final}};

renderer::RenderOptions options_of(const SceneCase& which, const Kind& kind, int threads) {
  renderer::RenderOptions options;
  if (kind.preset) {
    renderer::apply_preset(*kind.preset, options);
    if (*kind.preset == renderer::CachePreset::bare) options.cache.train_steps = 256;
  } else {
    options.integrator = renderer::Integrator::path;
    options.spp = 8;
    options.glass_shadows = renderer::GlassShadows::straight;
    if (kind.denoised) options.denoise.denoiser = renderer::DenoiserKind::automatic;
  }
  options.width = kPictureWidth;
  options.height = kPictureHeight;
  options.camera.name = which.camera;
  options.environment.constant = which.sky;
  options.environment.automatic = false;
  options.threads = threads;
  return options;
}

/// Google Benchmark calls a row several times, so the last renderer is kept.
struct Ready {
  std::string row;
  std::unique_ptr<scene::Scene> scene;
  std::unique_ptr<renderer::Renderer> renderer;
};

void make_picture(benchmark::State& state, const SceneCase& which, const Kind& kind) {
  static Ready ready;
  const std::filesystem::path file = file_of(which);
  if (file.empty()) return state.SkipWithError(kNoScene);
  const auto threads = static_cast<int>(state.range(0));
  const std::string row = std::string(which.name) + kind.name + std::to_string(threads);
  if (ready.row != row) {
    ready = {};
    ready.scene = std::make_unique<scene::Scene>(scene::load_gltf(file));
    ready.renderer = std::make_unique<renderer::Renderer>(*ready.scene, options_of(which, kind, threads));
    ready.row = row;
  }
  std::string record;
  for (auto _ : state) {
    if (schedule_file().empty()) {
      ready.renderer->render();
    } else {
      const schedule::Recording recording;
      ready.renderer->render();
      record = recording.json(threads);
    }
  }
  if (!record.empty()) write_schedule(record);
  const renderer::RenderStatistics& s = ready.renderer->statistics();
  state.counters["scout"] = s.cache.scout_seconds;
  state.counters["setup"] = s.cache.setup_seconds;
  state.counters["train"] = s.cache.train_seconds;
  state.counters["trace"] = s.cache.train_trace_seconds;
  state.counters["step"] = s.cache.train_step_seconds;
  state.counters["passes"] = s.render_seconds;
  state.counters["denoise"] = s.denoise_seconds;
}

const bool pictures_registered = [] {
  for (const SceneCase* which : {&kSalle, &kSponza, &kLiving, &kKitchen, &kBistro}) {
    for (const Kind& kind : kKinds) {
      const std::string name = std::string("picture/") + which->name + "/" + kind.name;
      benchmark::internal::Benchmark* const row = benchmark::RegisterBenchmark(
          name.c_str(), [which, kind](benchmark::State& s) { make_picture(s, *which, kind); });
      row->ArgName("threads")->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);
      for (const int threads : {1, 2, 3, 4, 8, 16, 32, 64}) row->Arg(threads);
    }
  }
  return true;
}();

}  // namespace
}  // namespace gatelight::bench
