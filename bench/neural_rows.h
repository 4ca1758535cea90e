#pragma once
// Common parts of train_step, query and mlp: the threads and the counters of a row.

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <chrono>

#include "bench/machine_limits.h"
#include "bench/neural_fixture.h"
#include "neural/cpu/cpu_backend.h"
#include "neural/model/training_options.h"
#include "renderer/machine/threads.h"

namespace gatelight::bench {

/// An arena of all threads that the process may use, as for the limits.
inline tbb::task_arena& all_threads() {
  static tbb::task_arena arena(renderer::available_threads());
  return arena;
}

/// The arithmetic whose limit a row is compared with: that of the instruction set in use.
inline Arithmetic arithmetic_in_use(bool bf16 = false) {
  const Arithmetic arithmetic = arithmetic_of(neural::cpu::select_isa());
  return bf16 && arithmetic == Arithmetic::avx512 && available_arithmetics().back() == Arithmetic::bf16
             ? Arithmetic::bf16
             : arithmetic;
}

/// Sets the counters for `operations` of the network and `reads` of feature vectors in `seconds`. Reads are
/// given where memory is the limit.
inline void set_fractions(benchmark::State& state, double operations, double seconds, Arithmetic arithmetic,
                          double reads = 0.0) {
  state.counters["GFLOP/s"] = operations / seconds / 1e9;
  state.counters["fraction_of_peak"] = operations / seconds / fma_limit(arithmetic);
  if (reads > 0) state.counters["fraction_of_gather"] = reads / seconds / gather_limit();
}

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace gatelight::bench
