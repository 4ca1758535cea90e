// load/SCENE: from the file to the scene with decoded textures. bvh/SCENE: from the scene to Embree's
// acceleration structure, on all threads. Both are in seconds.

#include <benchmark/benchmark.h>

#include <string>

#include "bench/world_fixture.h"
#include "scene/gltf.h"

namespace gatelight::bench {
namespace {

void load(benchmark::State& state, const SceneCase& which) {
  const std::filesystem::path file = file_of(which);
  if (file.empty()) return state.SkipWithError(kNoScene);
  std::size_t triangles = 0;
  std::size_t geometry = 0;
  std::size_t images = 0;
  for (auto _ : state) {
    const scene::Scene scene = scene::load_gltf(file);
    triangles = scene::count_triangles(scene);
    geometry = scene::geometry_bytes(scene);
    images = scene::image_bytes(scene);
  }
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["geometry_bytes/triangle"] = static_cast<double>(geometry) / static_cast<double>(triangles);
  state.counters["image_bytes"] = static_cast<double>(images);
}

void build(benchmark::State& state, const SceneCase& which) {
  const WorldFixture* w = world(which);
  if (!w) return state.SkipWithError(kNoScene);
  std::size_t bytes = 0;
  for (auto _ : state) {
    const renderer::Accel accel(w->scene, w->world.coverage, renderer::AccelOptions{});
    bytes = accel.bytes();
  }
  const std::size_t triangles = scene::count_triangles(w->scene);
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["bvh_bytes/triangle"] = static_cast<double>(bytes) / static_cast<double>(triangles);
}

const int load_registered = [] {
  for (const SceneCase* which : {&kSponza, &kKitchen, &kBistro}) {
    const auto add = [&](const std::string& name, auto function) {
      benchmark::RegisterBenchmark((name + "/" + which->name).c_str(),
                                   [=](benchmark::State& s) { function(s, *which); })
          ->UseRealTime()
          ->MeasureProcessCPUTime()
          ->Unit(benchmark::kSecond);
    };
    add("load", load);
    add("bvh", build);
  }
  return 0;
}();

}  // namespace
}  // namespace gatelight::bench
