// gatelight-bench: the micro-benchmarks. Filters, repetitions and JSON come with Google Benchmark (--help).

#include <benchmark/benchmark.h>

#include "base/platform/flush_denormals.h"
#include "base/platform/numa.h"

int main(int argc, char** argv) {
  // As in the program: before the first task starts.
  const gatelight::FlushDenormals flush;
  gatelight::interleave_memory();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
