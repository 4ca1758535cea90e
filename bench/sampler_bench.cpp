#include <benchmark/benchmark.h>

#include "renderer/sampling/sampler.h"

namespace gatelight::renderer {
namespace {

// One sampler per path and one dimension for every number, as in the integrator.
template <SamplerKind kKind>
void get_1d(benchmark::State& state) {
  Sampler sampler(kKind, 0, 3, 5, 7);
  std::uint32_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sampler);
    benchmark::DoNotOptimize(sampler.get_1d(i++ & 63u));
  }
}

template <SamplerKind kKind>
void get_2d(benchmark::State& state) {
  Sampler sampler(kKind, 0, 3, 5, 7);
  std::uint32_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sampler);
    const Vec2 u = sampler.get_2d(i++ & 63u);
    benchmark::DoNotOptimize(u.x() + u.y());
  }
}

BENCHMARK(get_1d<SamplerKind::sobol>)->Name("sampler/get_1d");
BENCHMARK(get_2d<SamplerKind::sobol>)->Name("sampler/get_2d");
BENCHMARK(get_1d<SamplerKind::independent>)->Name("sampler/independent/get_1d");
BENCHMARK(get_2d<SamplerKind::independent>)->Name("sampler/independent/get_2d");

}  // namespace
}  // namespace gatelight::renderer
