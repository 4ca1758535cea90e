// light_tree/{nee,mis}/{tree,power}/SCENE: noise and time of both ways to choose a light. The pictures show
// direct light at the first hit, by next-event estimation alone and by multiple importance sampling as
// rendered: 160x90 pixels, 16 samples at each pixel's centre, one thread. rel_mse is the error against a
// converged picture. worst_1% is the part of the error in the worst hundredth of the pixels. efficiency is 1
// / (rel_mse * seconds). The ratio of two efficiencies says how many times sooner the same noise is reached.

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <numeric>
#include <string>

#include "bench/world_fixture.h"
#include "renderer/film/camera_choice.h"
#include "renderer/transport/reference_pass.h"

namespace gatelight::bench {
namespace {

using renderer::LightSelection;

constexpr int kPictureWidth = 160;
constexpr int kPictureHeight = 90;
constexpr std::uint32_t kSpp = 16;
constexpr std::uint32_t kReferenceSpp = 512;

/// The direct light of one scene under one way to choose, in the program's own passes.
class DirectPicture {
 public:
  DirectPicture(const WorldFixture& fixture, LightSelection selection, renderer::DirectLight technique)
      : options_(options_for(fixture, technique)),
        world_(fixture.scene, options_.environment, selection),
        camera_(
            renderer::choose_camera(fixture.scene, options_.camera,
                                    static_cast<float>(kPictureWidth) / static_cast<float>(kPictureHeight)),
            kPictureWidth, kPictureHeight) {}

  /// RGB of each pixel, rows from the top. One thread.
  std::vector<float> render(std::uint32_t seed, std::uint32_t spp) {
    options_.seed = seed;
    renderer::ReferencePass pass(world_, {grid_, options_, camera_, filter_});
    renderer::Film film({0, 0, kPictureWidth, kPictureHeight}, kPictureWidth, kPictureHeight, {});
    tbb::task_arena(1).execute([&] { pass.run(0, spp, film, [](double) {}); });
    return film.resolve().layers.front().values;
  }

  std::size_t emitters() const { return world_.lights.emissive_triangles(); }

 private:
  static renderer::RenderOptions options_for(const WorldFixture& fixture, renderer::DirectLight technique) {
    renderer::RenderOptions options = fixture.options;
    options.max_depth = 1;
    options.direct = technique;
    return options;
  }

  renderer::RenderOptions options_;
  const renderer::World world_;
  const renderer::Camera camera_;
  const renderer::TileGrid grid_{{0, 0, kPictureWidth, kPictureHeight}};
  const renderer::FilterSampler filter_{renderer::PixelFilter::box, 1e-3f};  ///< the pixels' centres
};

const std::vector<float>& reference(const std::string& name, const WorldFixture& fixture) {
  static std::map<std::string, std::vector<float>> cache;
  auto [found, inserted] = cache.try_emplace(name);
  if (inserted) {
    found->second =
        DirectPicture(fixture, LightSelection::tree, renderer::DirectLight::mis).render(1, kReferenceSpp);
  }
  return found->second;
}

struct Error {
  double mean = 0.0;
  double worst_share = 0.0;
};

/// Squared error over squared reference plus a hundredth of the squared mean: dark pixels do not decide.
Error relative_error(const std::vector<float>& picture, const std::vector<float>& reference) {
  const auto pixel = [](const std::vector<float>& values, std::size_t i) {
    return Eigen::Array3d(Eigen::Map<const Eigen::Array3f>(&values[3 * i]).cast<double>());
  };
  const std::size_t pixels = reference.size() / 3;
  double mean = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) mean += pixel(reference, i).mean();
  mean /= static_cast<double>(pixels);
  std::vector<double> errors;
  for (std::size_t i = 0; i < pixels; ++i) {
    const Eigen::Array3d truth = pixel(reference, i);
    errors.push_back(((pixel(picture, i) - truth).square() / (truth.square() + 0.01 * mean * mean)).mean());
  }
  std::sort(errors.begin(), errors.end(), std::greater<>());
  const double total = std::accumulate(errors.begin(), errors.end(), 0.0);
  const double worst =
      std::accumulate(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 100), 0.0);
  return {total / static_cast<double>(errors.size()), total > 0.0 ? worst / total : 0.0};
}

void direct_light(benchmark::State& state, const SceneCase& which, renderer::DirectLight technique,
                  LightSelection selection) {
  const WorldFixture* w = world(which);
  if (!w) return state.SkipWithError(kNoScene);
  const std::vector<float>& converged = reference(which.name, *w);
  DirectPicture light(*w, selection, technique);
  double seconds = 0.0;
  Error error;
  std::uint32_t rounds = 0;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<float> picture = light.render(2 + rounds, kSpp);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++rounds;
    state.PauseTiming();
    const Error round = relative_error(picture, converged);
    error.mean += round.mean;
    error.worst_share += round.worst_share;
    state.ResumeTiming();
  }
  error.mean /= rounds;
  seconds /= rounds;
  state.counters["rel_mse"] = error.mean;
  state.counters["worst_1%"] = error.worst_share / rounds;
  state.counters["ns/sample"] = 1e9 * seconds / (static_cast<double>(kPictureWidth) * kPictureHeight * kSpp);
  state.counters["efficiency"] = 1.0 / (error.mean * seconds);
  state.counters["emitters"] = static_cast<double>(light.emitters());
}

const int light_tree_registered = [] {
  for (const SceneCase* which : {&kBistroNight, &kKitchen}) {
    for (const auto& [technique_name, technique] :
         {std::pair{"nee", renderer::DirectLight::nee}, std::pair{"mis", renderer::DirectLight::mis}}) {
      for (const auto& [name, selection] :
           {std::pair{"tree", LightSelection::tree}, std::pair{"power", LightSelection::power}}) {
        // The number of pictures is fixed, each with another seed, because rare bright samples make the error
        // of one picture unsteady.
        benchmark::RegisterBenchmark(
            (std::string("light_tree/") + technique_name + "/" + name + "/" + which->name).c_str(),
            [which, technique = technique, selection = selection](benchmark::State& s) {
              direct_light(s, *which, technique, selection);
            })
            ->Iterations(8)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace gatelight::bench
