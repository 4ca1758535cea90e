// vulkan/train_step and vulkan/query: the same rows as for the CPU, on the device that the environment
// variable GATELIGHT_BENCH_VULKAN names ("" is the best one), and vulkan/small_step: steps of 2048 records.
// Without the variable there are no rows. Counters are milliseconds and work of the device; the time of a row
// is that of the caller.

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

/// Reports the mean work of an iteration since the construction.
class CountedWork {
 public:
  void report(benchmark::State& state) const {
    const vulkan::DeviceWork now = vulkan::work_of(*shared_machine());
    const auto add = [&](const char* name, std::uint64_t vulkan::DeviceWork::*count) {
      state.counters[name] = {static_cast<double>(now.*count - before_.*count),
                              benchmark::Counter::kAvgIterations};
    };
    add("submissions", &vulkan::DeviceWork::submissions);
    add("dispatches", &vulkan::DeviceWork::dispatches);
    add("barriers", &vulkan::DeviceWork::barriers);
    add("bytes_to_device", &vulkan::DeviceWork::bytes_to_device);
    add("bytes_from_device", &vulkan::DeviceWork::bytes_from_device);
  }

 private:
  vulkan::DeviceWork before_ = vulkan::work_of(*shared_machine());
};

void train_step(benchmark::State& state, const NeuralCase& which, Order order, std::size_t records) {
  const auto model = neural_model(which);
  const auto backend = vulkan::make_vulkan_backend(shared_machine(), model, {});
  const TrainingBatches batches(order, model->config.mlp.outputs);
  const auto batch = [&](std::size_t i) { return batches.part(i, 0, records); };
  for (std::size_t i = 0; i < batches.count(); ++i) backend->train(batch(i));  // warm up
  const CountedWork work;
  StepSums sums;
  std::size_t started = 0, finished = 0;
  for (auto _ : state) {
    backend->start(batch(started++));
    if (started - finished <= kAhead) continue;
    sums.add(backend->finish());
    ++finished;
  }
  for (; finished < started; ++finished) sums.add(backend->finish());
  state.counters["device_ms"] = mean_ms(sums.step.seconds);
  sums.report(state);
  work.report(state);
}

void query(benchmark::State& state, const NeuralCase& which, Order order, neural::QueryPrecision precision) {
  const auto model = neural_model(which);
  const auto backend = vulkan::make_vulkan_backend(shared_machine(), model, {});
  const NeuralPoints& points = query_points(order);
  std::vector<float> out(points.size() * model->config.mlp.outputs);
  neural::QueryOptions options;
  options.precision = precision;
  backend->query(points.query_batch(), options, out);  // warm up
  const CountedWork work;
  for (auto _ : state) backend->query(points.query_batch(), options, out);
  work.report(state);
}

const bool vulkan_registered = [] {
  if (std::getenv("GATELIGHT_BENCH_VULKAN") == nullptr) return false;
  for (const Cache cache : {Cache::nrc, Cache::nao})
    for (const Encoding encoding : {Encoding::gate, Encoding::hash_grid})
      for (const Order order : {Order::coherent, Order::random}) {
        const NeuralCase which{cache, encoding};
        const std::string tail = case_name(which) + "/" + order_name(order);
        for (const auto& [word, records] :
             {std::pair{"train_step", std::size_t{kBatchRecords}}, {"small_step", std::size_t{2048}}})
          benchmark::RegisterBenchmark(fmt::format("vulkan/{}/{}", word, tail).c_str(), train_step, which,
                                       order, records)
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
