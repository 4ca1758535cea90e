// gatelight-mpi: gatelight with several ranks that make one picture.

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <string>

#include "apps/command_line.h"
#include "apps/mpi/mpi_ranks.h"
#include "apps/ranks/rank_group.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "base/platform/flush_denormals.h"
#include "base/platform/numa.h"

namespace gatelight::apps {
namespace {

/// Separates message and advice: ranks send a failure as one text.
constexpr char kSeparator = '\x1f';

void print_fault(int code, const std::string& line) {
  // A rank that prints in place of rank 0 was set silent.
  set_silent(false);
  const std::size_t at = line.find(kSeparator);
  const std::string advice = at == std::string::npos ? "" : line.substr(at + 1);
  print_failure_line({code, line.substr(0, at), advice});
}

RankCallbacks make_callbacks() {
  return {.on_fault = print_fault,
          .on_lost =
              [](int rank, const std::string& host, double seconds) {
                print_fault(kLost, fmt::format("rank {} ({}) has not answered for {:.0f} s; all ranks "
                                               "end{}--resume continues from the last --checkpoint",
                                               rank, host, seconds, kSeparator));
              },
          .on_stop = request_stop,
          .lost_code = kLost};
}

/// Seconds after which a silent rank is lost.
double silence() {
  constexpr double kUsual = 20.0;
  const char* const text = std::getenv("GATELIGHT_RANK_SILENCE");
  const double seconds = text ? std::atof(text) : 0.0;
  return seconds > 0.0 ? seconds : kUsual;
}

int run_ranks(int argc, char** argv) {
  MpiRanks ranks(&argc, &argv, make_callbacks(), silence());
  RankGroup group{ranks.all(), ranks.local_count(), ranks.hosts(),
                  [&](int part) -> renderer::Ranks& { return ranks.split(part); },
                  [&](int signal) { ranks.stop_others(signal); }};
  set_silent(!group.ranks.first());
  handle_failures([&](const Failure& failure) {
    ranks.fail(failure.code, failure.message + kSeparator + failure.advice);
  });
  const int code = run(argc, argv, group);
  ranks.end();
  return code;
}

}  // namespace
}  // namespace gatelight::apps

int main(int argc, char** argv) {
  using namespace gatelight;
  // TBB copies this state to its threads at its first use.
  const gatelight::FlushDenormals flush;
  interleave_memory();
  std::set_terminate(apps::end_program);
  apps::ignore_write_signals();
  try {
    return apps::run_ranks(argc, argv);
  } catch (const std::exception& error) {
    apps::set_silent(false);
    apps::print_failure_line(
        {apps::kUnavailable, error.what(), "start it with mpirun or srun, or use gatelight"});
    return apps::kUnavailable;
  }
}
