// light_tree/{nee,mis}/{tree,power}/SCENE: what the choice of lights saves. Direct light at the first hit, by
// next-event estimation alone and as it is rendered (multiple importance sampling), 160x90 pixels of 16
// samples at the pixels' centres, one thread. rel_mse is the error against a converged picture, worst_1% the
// share of it that a hundredth of the pixels holds; efficiency is 1 / (rel_mse * seconds): the ratio of two
// of them is how many times sooner the same noise is reached.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <numeric>
#include <string>

#include "bench/world_fixture.h"
#include "renderer/film/camera_choice.h"

namespace gatelight::bench {
namespace {

using renderer::LightSelection;

constexpr int kPictureWidth = 160;
constexpr int kPictureHeight = 90;
constexpr std::uint32_t kSpp = 16;
constexpr std::uint32_t kReferenceSpp = 512;

using Sums = std::vector<Eigen::Array3d>;

/// The direct light of one scene under one way to choose.
class DirectPicture {
 public:
  DirectPicture(const WorldFixture& fixture, const renderer::Lights& lights, renderer::DirectLight technique)
      : options_(options_for(fixture, technique)),
        world_{fixture.scene,
               fixture.requirements,
               *fixture.textures,
               *fixture.surfaces,
               *fixture.accel,
               *fixture.environment,
               lights},
        camera_(
            renderer::choose_camera(fixture.scene, options_.camera,
                                    static_cast<float>(kPictureWidth) / static_cast<float>(kPictureHeight)),
            kPictureWidth, kPictureHeight),
        integrator_(world_, path_integrator_options(options_)) {}

  /// Adds one sample to each pixel.
  void add(std::uint32_t seed, std::uint32_t sample, Sums& sums) {
    for (int y = 0; y < kPictureHeight; ++y) {
      row_.clear();
      for (int x = 0; x < kPictureWidth; ++x) {
        renderer::CameraSample s;
        s.sampler = renderer::Sampler(options_.sampler, seed, static_cast<std::uint32_t>(x),
                                      static_cast<std::uint32_t>(y), sample);
        s.seed = renderer::hash(static_cast<std::uint32_t>(y * kPictureWidth + x) ^
                                renderer::hash(sample ^ renderer::hash(seed)));
        s.camera_ray = camera_.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        row_.push_back(s);
      }
      results_.resize(row_.size());
      integrator_.trace(row_, results_, {}, rays_, scratch_);
      for (std::size_t x = 0; x < row_.size(); ++x) {
        sums[static_cast<std::size_t>(y * kPictureWidth) + x] += results_[x].radiance.cast<double>();
      }
    }
  }

 private:
  static renderer::RenderOptions options_for(const WorldFixture& fixture, renderer::DirectLight technique) {
    renderer::RenderOptions options = fixture.options;
    options.max_depth = 1;
    options.direct = technique;
    return options;
  }

  const renderer::RenderOptions options_;
  const renderer::World world_;
  const renderer::Camera camera_;
  const renderer::PathIntegrator integrator_;
  std::vector<renderer::CameraSample> row_;
  std::vector<renderer::SampleResult> results_;
  renderer::RayCounts rays_;
  renderer::PathIntegrator::Scratch scratch_;
};

Sums black() {
  return Sums(static_cast<std::size_t>(kPictureWidth) * kPictureHeight, Eigen::Array3d::Zero());
}

const Sums& reference(const std::string& name, const WorldFixture& fixture) {
  static std::map<std::string, Sums> cache;
  auto [found, inserted] = cache.try_emplace(name, black());
  if (inserted) {
    DirectPicture light(fixture, *fixture.lights, renderer::DirectLight::mis);
    for (std::uint32_t i = 0; i < kReferenceSpp; ++i) light.add(1, i, found->second);
    for (Eigen::Array3d& sum : found->second) sum /= kReferenceSpp;
  }
  return found->second;
}

struct Error {
  double mean = 0.0;
  double worst_share = 0.0;
};

/// Squared error over squared reference plus a hundredth of the squared mean: dark pixels do not decide.
Error relative_error(const Sums& sums, const Sums& reference) {
  double mean = 0.0;
  for (const Eigen::Array3d& r : reference) mean += r.mean();
  mean /= static_cast<double>(reference.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    errors.push_back(
        ((sums[i] / kSpp - reference[i]).square() / (reference[i].square() + 0.01 * mean * mean)).mean());
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
  const Sums& converged = reference(which.name, *w);
  const renderer::Lights lights(w->scene, *w->textures, *w->environment, selection);
  DirectPicture light(*w, lights, technique);
  Sums sums;
  double seconds = 0.0;
  Error error;
  std::uint32_t rounds = 0;
  for (auto _ : state) {
    sums = black();
    const auto start = std::chrono::steady_clock::now();
    for (std::uint32_t i = 0; i < kSpp; ++i) light.add(2 + rounds, i, sums);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++rounds;
    state.PauseTiming();
    const Error round = relative_error(sums, converged);
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
  state.counters["emitters"] = static_cast<double>(lights.emissive_triangles());
}

const int light_tree_registered = [] {
  for (const SceneCase* which : {&kBistroNight, &kKitchen}) {
    for (const auto& [technique_name, technique] :
         {std::pair{"nee", renderer::DirectLight::nee}, std::pair{"mis", renderer::DirectLight::mis}}) {
      for (const auto& [name, selection] :
           {std::pair{"tree", LightSelection::tree}, std::pair{"power", LightSelection::power}}) {
        // A fixed number of pictures, each of another seed: rare bright samples make the error of one
        // unsteady.
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
