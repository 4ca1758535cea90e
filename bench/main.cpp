// gatelight-bench: the micro-benchmarks. Filters, repetitions and JSON come with Google Benchmark (--help).

#include <benchmark/benchmark.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

int main(int argc, char** argv) {
  // As in the renderer: before the first task starts.
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
