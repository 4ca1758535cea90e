// train_step/{nrc,nao}/{gate,hashgrid}/{coherent,random}: a training step of 49152 records on one million
// triangles. small_steps/...: 24 steps of 2048 records each, as pictures have, by one Team.

#include <string>

#include "base/parallel/schedule.h"
#include "base/parallel/team.h"
#include "bench/neural_rows.h"
#include "bench/schedule_file.h"

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

void small_steps(benchmark::State& state, Order order) {
  constexpr std::size_t kRecords = 2048, kSteps = kBatchRecords / kRecords;
  const int threads = static_cast<int>(state.range(0));
  tbb::task_arena(threads).execute([&] {
    const TrainCase which{{Cache::nrc, Encoding::gate}, order};
    Learner learner(which);
    const auto all_steps = [&] {
      const std::size_t batch = learner.steps++;
      Team::run([&](Team& team) {
        for (std::size_t i = 0; i < kSteps; ++i)
          learner.backend->train(learner.batches.part(batch, i * kRecords, kRecords), team);
      });
    };
    std::string record;
    const double seconds = timed_seconds(state, [&] {
      if (schedule_file().empty()) return all_steps();
      const schedule::Recording recording;
      all_steps();
      record = recording.json(threads);
    });
    if (!record.empty()) write_schedule(record);
    state.counters["step_ms"] = 1e3 * seconds / static_cast<double>(state.iterations() * kSteps);
  });
}

const bool small_registered = [] {
  for (const Order order : {Order::coherent, Order::random}) {
    const std::string name = "small_steps/" + order_name(order);
    auto* const row = benchmark::RegisterBenchmark(name.c_str(), small_steps, order);
    row->ArgName("threads")->UseRealTime()->Unit(benchmark::kMillisecond);
    for (const int threads : {1, 2, 4, 8, 16, 32, 64}) row->Arg(threads);
  }
  return true;
}();

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
