// mlp/{nrc,nao}: only the network's arithmetic, on 49152 samples with encoded inputs.

#include "base/random.h"
#include "bench/neural_rows.h"

namespace gatelight::bench {
namespace {

std::vector<float> random_floats(std::size_t count, std::uint64_t seed) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = uniform_float(seed, i);
  return values;
}

void mlp(benchmark::State& state, Cache cache) {
  all_threads().execute([&] {
    const auto model = neural_model({cache, Encoding::gate});
    const neural::ParameterLayout& layout = model->parameters;
    const auto backend = neural::cpu::make_cpu_backend(model, {});
    std::uint32_t stride = 16;
    while (stride < layout.inputs) stride *= 2;
    const std::vector<float> inputs = random_floats(std::size_t{kBatchRecords} * stride, 1);
    const std::vector<float> targets =
        random_floats(std::size_t{kBatchRecords} * model->config.mlp.outputs, 2);
    neural::cpu::network_pass(*backend, inputs, targets);  // warm up
    const double seconds =
        timed_seconds(state, [&] { neural::cpu::network_pass(*backend, inputs, targets); });
    set_fractions(state, records(state) * training_operations(layout), seconds, arithmetic_in_use());
  });
}

BENCHMARK_CAPTURE(mlp, nrc, Cache::nrc)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mlp, nao, Cache::nao)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gatelight::bench
