// train_step/{nrc,nao}/{gate,hashgrid}/{coherent,random}: a training step of 49152 records on one million
// triangles.

#include <string>

#include "bench/neural_rows.h"

namespace gatelight::bench {
namespace {

struct TrainCase {
  NeuralCase model;
  Order order = Order::coherent;
  neural::FeatureUpdate update = neural::FeatureUpdate::sparse;
  neural::FeaturePrecision precision = neural::FeaturePrecision::fp32;
  bool denormal = false;  ///< weights and targets so small that activations and gradients would be denormal
  friend bool operator==(const TrainCase&, const TrainCase&) = default;
};

/// Google Benchmark calls a row several times, so the last backend is kept.
struct Learner {
  TrainCase which;
  std::shared_ptr<const neural::Model> model;
  std::unique_ptr<neural::Backend> backend;
  TrainingBatches batches;
  std::size_t steps = 0;

  explicit Learner(const TrainCase& c)
      : which(c), model(neural_model(c.model)), batches(c.order, model->config.mlp.outputs) {
    neural::TrainingOptions options;
    options.update = c.update;
    options.precision = c.precision;
    if (c.denormal) {
      options.loss = neural::Loss::l2;
      options.start_at_mean = false;
      options.adam.l2_network = 0.0f;
    }
    backend = neural::cpu::make_cpu_backend(model, options);
    if (c.denormal) {
      neural::ModelState state = backend->export_state();
      for (float& p : state.parameters) p *= 1e-19f;
      state.averages = state.parameters;
      backend->import_state(state);
      for (std::vector<float>& batch : batches.targets)
        for (float& t : batch) t *= 1e-38f;
    }
    while (steps < batches.count()) step();  // warm up: memory, threads, every batch once
  }

  neural::StepStatistics step() { return backend->train(batches[steps++]); }
};

void train_step(benchmark::State& state, const TrainCase& which) {
  static std::unique_ptr<Learner> learner;
  all_threads().execute([&] {
    if (learner == nullptr || learner->which != which) {
      learner.reset();
      learner = std::make_unique<Learner>(which);
    }
    StepSums sums;
    for (auto _ : state) sums.add(learner->step());
    sums.report(state);
    state.counters["touched"] = {sums.touched, benchmark::Counter::kAvgIterations};
    state.counters["feature_MB"] = static_cast<double>(learner->backend->parameter_bytes()) / 1e6;
  });
}

const bool train_registered = [] {
  const auto add = [](TrainCase which, const char* suffix) {
    for (const Order order : {Order::coherent, Order::random, Order::sorted}) {
      if (order == Order::sorted && which.model.encoding != Encoding::gate) continue;
      which.order = order;
      const std::string name = "train_step/" + case_name(which.model) + suffix + "/" + order_name(order);
      benchmark::RegisterBenchmark(name.c_str(), train_step, which)->Unit(benchmark::kMillisecond);
    }
  };
  for (const Cache cache : {Cache::nrc, Cache::nao}) {
    for (const Encoding encoding : {Encoding::gate, Encoding::hash_grid}) {
      TrainCase which{{cache, encoding}};
      add(which, "");
      if (encoding == Encoding::gate) {
        which.precision = neural::FeaturePrecision::fp16;
        add(which, "_fp16");
        which.precision = neural::FeaturePrecision::fp32;
        which.denormal = true;
        add(which, "_denormal");
      }
      if (encoding == Encoding::hash_grid) {
        which.update = neural::FeatureUpdate::dense;
        add(which, "_dense");
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace gatelight::bench
