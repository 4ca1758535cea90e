// mlp/{nrc,nao}: the network's arithmetic alone, on 49152 samples with encoded inputs. mlp/nrc/eigen: the
// same by Eigen's matrix products, which is the usual code without kernels.

#include <tbb/parallel_for.h>

#include <algorithm>

#include "bench/mlp_eigen.h"
#include "bench/neural_rows.h"
#include "neural/base/random.h"

namespace gatelight::bench {
namespace {

std::vector<float> random_floats(std::size_t count, std::uint64_t seed) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = neural::uniform_float(seed, i);
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
    double seconds = 0.0, passes = 0.0;
    for (auto _ : state) {
      const Stopwatch watch;
      neural::cpu::network_pass(*backend, inputs, targets);
      seconds += watch.seconds();
      passes += 1.0;
    }
    set_fractions(state, passes * kBatchRecords * training_operations(layout), seconds, arithmetic_in_use());
  });
}

void mlp_eigen(benchmark::State& state, EigenChunk chunk, Arithmetic arithmetic) {
  constexpr std::size_t kSamples = 96;
  constexpr std::size_t kChunks = kBatchRecords / kSamples;
  static_assert(kBatchRecords % kSamples == 0);
  using N = EigenNetwork;
  const std::vector<float> inputs = random_floats(std::size_t{kBatchRecords} * N::kInputs, 1);
  const std::vector<float> targets = random_floats(std::size_t{kBatchRecords} * N::kOutputs, 2);
  std::vector<float> weights = random_floats(N::kWeights, 3);
  for (float& weight : weights) weight = 0.5f * (weight - 0.5f);
  std::vector<float> feature_gradients(std::size_t{kBatchRecords} * N::kFeatureInputs);
  const N network{weights.data()};
  const auto slices = static_cast<std::size_t>(renderer::available_threads());
  std::vector<std::vector<float>> gradients(slices, std::vector<float>(N::kWeights));
  all_threads().execute([&] {
    double seconds = 0.0, passes = 0.0;
    for (auto _ : state) {
      const Stopwatch watch;
      tbb::parallel_for(std::size_t{0}, slices, [&](std::size_t slice) {
        std::fill(gradients[slice].begin(), gradients[slice].end(), 0.0f);
        for (std::size_t c = kChunks * slice / slices; c < kChunks * (slice + 1) / slices; ++c) {
          const std::size_t first = c * kSamples;
          benchmark::DoNotOptimize(
              chunk(network, inputs.data() + first * N::kInputs, targets.data() + first * N::kOutputs,
                    kSamples, gradients[slice].data(), feature_gradients.data() + first * N::kFeatureInputs));
        }
      });
      for (std::size_t slice = 1; slice < slices; ++slice)
        std::transform(gradients[0].begin(), gradients[0].end(), gradients[slice].begin(),
                       gradients[0].begin(), std::plus<>());
      benchmark::DoNotOptimize(gradients[0].data());
      seconds += watch.seconds();
      passes += 1.0;
    }
    const auto model = neural_model({Cache::nrc, Encoding::gate});
    set_fractions(state, passes * kBatchRecords * training_operations(model->parameters), seconds,
                  arithmetic);
  });
}

const bool mlp_registered = [] {
  benchmark::RegisterBenchmark("mlp/nrc", mlp, Cache::nrc)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("mlp/nao", mlp, Cache::nao)->Unit(benchmark::kMillisecond);
  const auto add_eigen = [](neural::cpu::Isa isa, EigenChunk chunk) {
    const auto available = neural::cpu::available_isas();
    if (std::find(available.begin(), available.end(), isa) == available.end()) return;
    const std::string name = "mlp/nrc/eigen/" + std::string(neural::cpu::isa_name(isa));
    benchmark::RegisterBenchmark(name.c_str(), mlp_eigen, chunk, arithmetic_of(isa))
        ->Unit(benchmark::kMillisecond);
  };
  add_eigen(neural::cpu::Isa::avx2, eigen_chunk_avx2);
  add_eigen(neural::cpu::Isa::avx512, eigen_chunk_avx512);
  return true;
}();

}  // namespace
}  // namespace gatelight::bench
