// vulkan/train_step and vulkan/query: the same rows as for the CPU, on the device that the environment
// variable GATELIGHT_BENCH_VULKAN names ("" is the best one). Without the variable there are no rows.
// Counters are milliseconds of the device; the time of a row is that of the caller.

#include <fmt/format.h>

#include <cstdlib>

#include "bench/neural_rows.h"
#include "neural/vulkan/measured_limits.h"

namespace gatelight::bench {
namespace {

namespace vulkan = neural::vulkan;

constexpr std::uint64_t kReadBytes = std::uint64_t{256} << 20;
/// Steps that are started before the first wait.
constexpr std::size_t kAhead = 2;

std::shared_ptr<vulkan::Machine> shared_machine() {
  static const std::shared_ptr<vulkan::Machine> opened =
      vulkan::open_machine({.device = std::getenv("GATELIGHT_BENCH_VULKAN")});
  return opened;
}

const vulkan::MeasuredLimits& limits() {
  static const vulkan::MeasuredLimits measured = vulkan::measure_limits(*shared_machine(), kReadBytes);
  return measured;
}

/// The bytes that a step has to move if each goes over the bus once, for a number of records and of touched
/// nodes.
double step_bytes(const neural::Model& model, double records, double touched) {
  const double vector = 4.0 * model.parameters.features;
  const double read = records * model.nodes_per_point() * vector;  // interpolation
  return read + touched * (2 * 4 * vector + 8);                    // feature, two moments, average, counter
}

/// Sets the fractions of the device's limits, unless it has no timestamps.
void set_device_fractions(benchmark::State& state, double operations, double bytes, double seconds) {
  if (seconds == 0.0) return;
  state.counters["fraction_of_arithmetic"] = operations / seconds / limits().operations_per_second;
  state.counters["fraction_of_bandwidth"] = bytes / seconds / limits().bytes_per_second;
}

void limit_rows(benchmark::State& state) {
  for (auto _ : state) {
    double bytes_per_second = limits().bytes_per_second;
    benchmark::DoNotOptimize(bytes_per_second);
  }
  state.counters["GFLOP/s"] = limits().operations_per_second / 1e9;
  state.counters["GB/s"] = limits().bytes_per_second / 1e9;
  state.SetLabel(vulkan::machine_name(*shared_machine()));
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
  set_device_fractions(state, records(state) * training_operations(model->parameters),
                       step_bytes(*model, records(state), sums.touched), sums.step.seconds);
}

void query(benchmark::State& state, const NeuralCase& which, Order order, neural::QueryPrecision precision) {
  const auto model = neural_model(which);
  const auto backend = vulkan::make_vulkan_backend(shared_machine(), model, {});
  const NeuralPoints& points = query_points(order);
  std::vector<float> out(points.size() * model->config.mlp.outputs);
  neural::QueryOptions options;
  options.precision = precision;
  backend->query(points.query_batch(), options, out);  // warm up
  vulkan::QuerySeconds sum;
  for (auto _ : state) {
    backend->query(points.query_batch(), options, out);
    const vulkan::QuerySeconds seconds = vulkan::last_query_seconds(*backend);
    sum.encode += seconds.encode;
    sum.network += seconds.network;
    sum.copies += seconds.copies;
  }
  state.counters["device_ms"] = mean_ms(sum.encode + sum.network);
  state.counters["encode_ms"] = mean_ms(sum.encode);
  state.counters["network_ms"] = mean_ms(sum.network);
  state.counters["copies_ms"] = mean_ms(sum.copies);
  const double answers = static_cast<double>(state.iterations()) * static_cast<double>(points.size());
  const double bytes = answers * model->nodes_per_point() * 4.0 * model->parameters.features;
  set_device_fractions(state, answers * forward_operations(model->parameters), bytes,
                       sum.encode + sum.network);
}

const bool vulkan_registered = [] {
  if (std::getenv("GATELIGHT_BENCH_VULKAN") == nullptr) return false;
  benchmark::RegisterBenchmark("vulkan/limits", limit_rows)->Iterations(1);
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
