// limits/*: the limits of the machine, on all threads. A row shows the best of its passes; the time is the
// mean of a pass.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "bench/machine_limits.h"

namespace gatelight::bench {
namespace {

template <class Pass>
void run_passes(benchmark::State& state, const char* counter, double unit, Pass&& pass) {
  double best = 0.0;
  for (auto _ : state) best = std::max(best, pass().rate());
  state.counters[counter] = best / unit;
}

void fma(benchmark::State& state, Arithmetic arithmetic) {
  run_passes(state, "GFLOP/s", 1e9, [&] { return run_fma(arithmetic); });
}

void stream(benchmark::State& state) {
  const BigBuffer buffer;
  run_passes(state, "GB/s", 1e9, [&] { return run_stream(buffer); });
}

void gather(benchmark::State& state, bool huge_pages) {
  const BigBuffer buffer(huge_pages);
  run_passes(state, "Mread/s", 1e6, [&] { return run_gather(buffer); });
}

const bool limits_registered = [] {
  const auto add = [](const std::string& name, auto function, auto... arguments) {
    benchmark::RegisterBenchmark(name.c_str(), function, arguments...)->Unit(benchmark::kMillisecond);
  };
  Arithmetic widest = Arithmetic::sse2;
  for (const Arithmetic arithmetic : available_arithmetics()) {
    add("limits/fma/" + std::string(arithmetic_name(arithmetic)), fma, arithmetic);
    if (arithmetic != Arithmetic::bf16) widest = arithmetic;
  }
  add("limits/fma", fma, widest);
  add("limits/stream", stream);
  add("limits/gather", gather, true);
  add("limits/gather/small_pages", gather, false);
  return true;
}();

}  // namespace
}  // namespace gatelight::bench
