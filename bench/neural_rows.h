#pragma once
// Common parts of train_step and query: the threads and the counters of a row.

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <chrono>

#include "base/platform/threads.h"
#include "bench/neural_fixture.h"
#include "neural/cpu/cpu_backend.h"
#include "neural/model/training_options.h"

namespace gatelight::bench {

/// An arena of all threads that the process may use.
inline tbb::task_arena& all_threads() {
  static tbb::task_arena arena(available_threads());
  return arena;
}

/// Runs the row. Returns the elapsed seconds of all its iterations.
template <class Body>
double timed_seconds(benchmark::State& state, Body&& body) {
  using Clock = std::chrono::steady_clock;
  Clock::duration elapsed{};
  for (auto _ : state) {
    const Clock::time_point start = Clock::now();
    body();
    elapsed += Clock::now() - start;
  }
  return std::chrono::duration<double>(elapsed).count();
}

/// The counter is a mean per iteration, in milliseconds.
inline benchmark::Counter mean_ms(double seconds) {
  return {1e3 * seconds, benchmark::Counter::kAvgIterations};
}

/// Sums of the statistics of a row's steps.
struct StepSums {
  neural::StepStatistics step;
  double touched = 0.0;

  void add(const neural::StepStatistics& other) {
    step.seconds += other.seconds;
    step.seconds_network += other.seconds_network;
    step.seconds_sort += other.seconds_sort;
    step.seconds_update += other.seconds_update;
    touched += static_cast<double>(other.touched_nodes);
  }
  void report(benchmark::State& state) const {
    state.counters["network_ms"] = mean_ms(step.seconds_network);
    state.counters["sort_ms"] = mean_ms(step.seconds_sort);
    state.counters["update_ms"] = mean_ms(step.seconds_update);
  }
};

/// The batches of training_points() with their targets.
class TrainingBatches {
 public:
  TrainingBatches(Order order, std::uint32_t outputs) : points_(training_points(order)) {
    for (const NeuralPoints& points : points_) targets.push_back(training_targets(points, outputs));
  }
  std::size_t count() const { return targets.size(); }
  /// Begins again after the last batch.
  neural::TrainingBatch operator[](std::size_t i) const {
    return {points_[i % count()].query_batch(), targets[i % count()]};
  }
  /// `records` of batch i from `first` on.
  neural::TrainingBatch part(std::size_t i, std::size_t first, std::size_t records) const {
    const auto some = [&](const auto& span, std::size_t each = 1) {
      return span.empty() ? span : span.subspan(each * first, each * records);
    };
    const neural::TrainingBatch all = (*this)[i];
    const neural::QueryBatch& p = all.points;
    const neural::QueryBatch points{some(p.surfaces),  some(p.triangles),   some(p.barycentrics),
                                    some(p.positions), some(p.directions),  some(p.normals),
                                    some(p.albedos),   some(p.roughnesses), records};
    return {points, some(all.targets, all.targets.size() / all.points.size)};
  }

  std::vector<std::vector<float>> targets;

 private:
  const std::vector<NeuralPoints>& points_;
};

}  // namespace gatelight::bench
