// reconstruct/ISA/threads:N: 1920x1080 pixels of 16 samples, of two surfaces in smooth light. The counter is
// million pixels a second.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>
#include <string>

#include "neural/simd/isa.h"
#include "renderer/reconstruction/reconstruct.h"

namespace gatelight::bench {
namespace {

constexpr int kWidth = 1920;
constexpr int kHeight = 1080;

renderer::SampledPicture noisy_picture() {
  constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
  constexpr float kDeviation = 0.5f;  // of the mean of a half
  renderer::SampledPicture s{.width = kWidth, .height = kHeight};
  for (auto& half : s.halves) half.color.resize(3 * kPixels), half.variance.resize(3 * kPixels);
  s.counts.assign(kPixels, 16.0f);
  s.coverage.assign(kPixels, 1.0f);
  s.albedo.assign(3 * kPixels, 0.5f);
  s.normal.assign(3 * kPixels, 0.0f);
  s.depth.assign(kPixels, 5.0f);
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0f, kDeviation);
  for (std::size_t p = 0; p < kPixels; ++p) {
    const auto x = static_cast<float>(p % kWidth), y = static_cast<float>(p / kWidth);
    s.normal[3 * p + (p % kWidth / 64 % 2 == 0 ? 1 : 2)] = 1.0f;
    const float light = 2.0f + std::sin(0.01f * x) + std::sin(0.013f * y);
    for (auto& half : s.halves) {
      for (std::size_t c = 0; c < 3; ++c) {
        half.color[3 * p + c] = light * (1.0f + noise(random));
        half.variance[3 * p + c] = light * light * kDeviation * kDeviation;
      }
    }
  }
  return s;
}

void reconstruct(benchmark::State& state, const std::string& isa, int threads) {
  static const renderer::SampledPicture samples = noisy_picture();
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  for (auto _ : state) benchmark::DoNotOptimize(renderer::reconstruct(samples, {.isa = isa}).color.data());
  state.counters["Mpixels"] =
      benchmark::Counter(1e-6 * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate);
}

const bool registered = [] {
  for (const neural::simd::Isa isa : neural::simd::available_isas()) {
    const std::string name(neural::simd::isa_name(isa));
    for (const int threads : {1, 2}) {
      benchmark::RegisterBenchmark(("reconstruct/" + name + "/threads:" + std::to_string(threads)).c_str(),
                                   reconstruct, name, threads)
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
  return true;
}();

}  // namespace
}  // namespace gatelight::bench
