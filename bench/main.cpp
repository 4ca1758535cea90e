// gatelight-bench: the micro-benchmarks. Filters, repetitions and JSON come with Google Benchmark (--help).
// --schedule=FILE records the last picture of the rows picture/.

#include <benchmark/benchmark.h>

#include <string_view>

#include "base/platform/flush_denormals.h"
#include "bench/schedule_file.h"

namespace gatelight::bench {

std::string& schedule_file() {
  static std::string file;
  return file;
}

}  // namespace gatelight::bench

int main(int argc, char** argv) {
  // As in the renderer: before the first task starts.
  const gatelight::FlushDenormals flush;
  benchmark::Initialize(&argc, argv);
  constexpr std::string_view kSchedule = "--schedule=";
  if (argc > 1 && std::string_view(argv[argc - 1]).starts_with(kSchedule))
    gatelight::bench::schedule_file() = argv[--argc] + kSchedule.size();
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
