// The main of gatelight-bench and gatelight-bench-neural. Filters, repetitions and JSON come with Google Benchmark (--help).
// --schedule=FILE, the last argument, records the schedule of the last row of picture/ or small_steps/.

#include <benchmark/benchmark.h>

#include <fstream>
#include <string_view>

#include "base/platform/flush_denormals.h"
#include "base/platform/numa.h"
#include "bench/schedule_file.h"

namespace gatelight::bench {

std::string& schedule_file() {
  static std::string file;
  return file;
}

void write_schedule(const std::string& json) {
  std::ofstream(schedule_file()) << json;
}

}  // namespace gatelight::bench

int main(int argc, char** argv) {
  // As in the program: before the first task starts.
  const gatelight::FlushDenormals flush;
  gatelight::interleave_memory();
  benchmark::Initialize(&argc, argv);
  constexpr std::string_view kSchedule = "--schedule=";
  if (argc > 1 && std::string_view(argv[argc - 1]).starts_with(kSchedule))
    gatelight::bench::schedule_file() = argv[--argc] + kSchedule.size();
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
