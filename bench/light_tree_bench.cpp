// light_tree/{tree,power}/SCENE: what the choice of lights saves. Direct light at the first hit, as it is
// rendered (multiple importance sampling), 160x90 pixels of 16 samples at the pixels' centres, one thread.
// rel_mse is the error against a converged picture; efficiency is 1 / (rel_mse * seconds): the ratio of two
// of them is how many times sooner the same noise is reached.

#include <benchmark/benchmark.h>

#include <chrono>
#include <map>
#include <string>

#include "bench/world_fixture.h"

namespace gatelight::bench {
namespace {

using renderer::LightSelection;

constexpr int kPictureWidth = 160;
constexpr int kPictureHeight = 90;
constexpr std::uint32_t kSpp = 16;
constexpr std::uint32_t kReferenceSpp = 512;

using Sums = std::vector<Eigen::Array3d>;

/// The direct light of one scene under one way to choose.
class DirectLight {
 public:
  DirectLight(const WorldFixture& fixture, const renderer::Lights& lights)
      : options_(options_for(fixture)),
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
        integrator_(world_, options_) {}

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
  static renderer::RenderOptions options_for(const WorldFixture& fixture) {
    renderer::RenderOptions options = fixture.options;
    options.max_depth = 1;
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
    DirectLight light(fixture, *fixture.lights);
    for (std::uint32_t i = 0; i < kReferenceSpp; ++i) light.add(1, i, found->second);
    for (Eigen::Array3d& sum : found->second) sum /= kReferenceSpp;
  }
  return found->second;
}

/// Squared error over squared reference plus a hundredth of the squared mean: dark pixels do not decide.
double relative_error(const Sums& sums, const Sums& reference) {
  double mean = 0.0;
  for (const Eigen::Array3d& r : reference) mean += r.mean();
  mean /= static_cast<double>(reference.size());
  double error = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    error += ((sums[i] / kSpp - reference[i]).square() / (reference[i].square() + 0.01 * mean * mean)).mean();
  }
  return error / static_cast<double>(sums.size());
}

void direct_light(benchmark::State& state, const SceneCase& which, LightSelection selection) {
  const WorldFixture* w = world(which);
  if (!w) return state.SkipWithError(kNoScene);
  const Sums& converged = reference(which.name, *w);
  const renderer::Lights lights(w->scene, *w->textures, *w->environment, selection);
  DirectLight light(*w, lights);
  Sums sums;
  double seconds = 0.0;
  double error = 0.0;
  std::uint32_t rounds = 0;
  for (auto _ : state) {
    sums = black();
    const auto start = std::chrono::steady_clock::now();
    for (std::uint32_t i = 0; i < kSpp; ++i) light.add(2 + rounds, i, sums);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++rounds;
    state.PauseTiming();
    error += relative_error(sums, converged);
    state.ResumeTiming();
  }
  error /= rounds;
  seconds /= rounds;
  state.counters["rel_mse"] = error;
  state.counters["ns/sample"] = 1e9 * seconds / (static_cast<double>(kPictureWidth) * kPictureHeight * kSpp);
  state.counters["efficiency"] = 1.0 / (error * seconds);
  state.counters["emitters"] = static_cast<double>(lights.emissive_triangles());
}

const int registered = [] {
  for (const SceneCase* which : {&kBistroNight, &kKitchen}) {
    for (const auto& [name, selection] :
         {std::pair{"tree", LightSelection::tree}, std::pair{"power", LightSelection::power}}) {
      benchmark::RegisterBenchmark(
          (std::string("light_tree/") + name + "/" + which->name).c_str(),
          [which, selection = selection](benchmark::State& s) { direct_light(s, *which, selection); })
          ->Unit(benchmark::kMillisecond);
    }
  }
  return 0;
}();

}  // namespace
}  // namespace gatelight::bench
