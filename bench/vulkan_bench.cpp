// vulkan/train_step and vulkan/query: the same rows as for the CPU, on the device that the environment
// variable GATELIGHT_BENCH_VULKAN names ("" is the best one). Without the variable there are no rows.
// Counters are milliseconds of the device; the time of a row is that of the caller.

#include <fmt/format.h>

#include <cstdlib>

#include "bench/neural_rows.h"
#include "neural/vulkan/vulkan_backend.h"

namespace gatelight::bench {
namespace {

namespace vulkan = neural::vulkan;

/// Steps that are started before the first wait.
constexpr std::size_t kAhead = 2;

std::shared_ptr<vulkan::Machine> shared_machine() {
  static const std::shared_ptr<vulkan::Machine> opened =
      vulkan::open_machine({.device = std::getenv("GATELIGHT_BENCH_VULKAN")});
  return opened;
}

void train_step(benchmark::State& state, const NeuralCase& which, Order order) {
  const auto model = neural_model(which);
  const auto backend = vulkan::make_vulkan_backend(shared_machine(), model, {});
  const TrainingBatches batches(order, model->config.mlp.outputs);
  for (std::size_t i = 0; i < batches.count(); ++i) backend->train(batches[i]);  // warm up
  StepSums sums;
  std::size_t started = 0, finished = 0;
  for (auto _ : state) {
    backend->start(batches[started++]);
    if (started - finished <= kAhead) continue;
    sums.add(backend->finish());
    ++finished;
  }
  for (; finished < started; ++finished) sums.add(backend->finish());
  state.counters["device_ms"] = mean_ms(sums.step.seconds);
  sums.report(state);
}

void query(benchmark::State& state, const NeuralCase& which, Order order, neural::QueryPrecision precision) {
  const auto model = neural_model(which);
  const auto backend = vulkan::make_vulkan_backend(shared_machine(), model, {});
  const NeuralPoints& points = query_points(order);
  std::vector<float> out(points.size() * model->config.mlp.outputs);
  neural::QueryOptions options;
  options.precision = precision;
  backend->query(points.query_batch(), options, out);  // warm up
  for (auto _ : state) backend->query(points.query_batch(), options, out);
}

const bool vulkan_registered = [] {
  if (std::getenv("GATELIGHT_BENCH_VULKAN") == nullptr) return false;
  for (const Cache cache : {Cache::nrc, Cache::nao})
    for (const Encoding encoding : {Encoding::gate, Encoding::hash_grid})
      for (const Order order : {Order::coherent, Order::random}) {
        const NeuralCase which{cache, encoding};
        const std::string tail = case_name(which) + "/" + order_name(order);
        benchmark::RegisterBenchmark(("vulkan/train_step/" + tail).c_str(), train_step, which, order)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
        for (const auto& [word, precision] :
             {std::pair{"fp32", neural::QueryPrecision::fp32}, {"bf16", neural::QueryPrecision::bf16}})
          benchmark::RegisterBenchmark(fmt::format("vulkan/query/{}/{}", tail, word).c_str(), query, which,
                                       order, precision)
              ->Unit(benchmark::kMillisecond)
              ->UseRealTime();
      }
  return true;
}();

}  // namespace
}  // namespace gatelight::bench
