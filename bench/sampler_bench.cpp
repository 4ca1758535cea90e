#include <benchmark/benchmark.h>

#include "renderer/sampling/sampler.h"

namespace gatelight::renderer {
namespace {

// One sampler per path and one dimension for every number, as in the integrator.
template <SamplerKind kKind, int kDimensions>
void get(benchmark::State& state) {
  Sampler sampler(kKind, 0, 3, 5, 7);
  std::uint32_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sampler);
    const std::uint32_t dimension = i++ & 63u;
    if constexpr (kDimensions == 1) {
      benchmark::DoNotOptimize(sampler.get_1d(dimension));
    } else {
      benchmark::DoNotOptimize(sampler.get_2d(dimension).sum());
    }
  }
}

BENCHMARK(get<SamplerKind::sobol, 1>)->Name("sampler/get_1d");
BENCHMARK(get<SamplerKind::sobol, 2>)->Name("sampler/get_2d");
BENCHMARK(get<SamplerKind::independent, 1>)->Name("sampler/independent/get_1d");
BENCHMARK(get<SamplerKind::independent, 2>)->Name("sampler/independent/get_2d");

}  // namespace
}  // namespace gatelight::renderer
