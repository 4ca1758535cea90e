// gatelight-mpi: gatelight with several ranks that make one picture.

#include <cstdlib>
#include <exception>

#include "apps/command_line.h"
#include "apps/mpi/failures.h"
#include "apps/mpi/mpi_team.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "base/platform/flush_denormals.h"
#include "base/platform/numa.h"

namespace gatelight::apps {
namespace {

/// Seconds after which a silent rank is lost.
double silence() {
  constexpr double kUsual = 20.0;
  const char* const text = std::getenv("GATELIGHT_RANK_SILENCE");
  const double seconds = text ? std::atof(text) : 0.0;
  return seconds > 0.0 ? seconds : kUsual;
}

int run_ranks(int argc, char** argv) {
  MpiRanks ranks(&argc, &argv, silence());
  int code = kDone;
  if (ranks.all().is_single()) {
    code = run(argc, argv);
  } else {
    set_silent(!ranks.all().first());
    handle_failures([&](const Failure& failure) { ranks.fail(failure); });
    MpiTeam team(ranks);
    code = run(argc, argv, team);
  }
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
    apps::print_for_all({apps::kUnavailable, error.what(), "start it with mpirun or srun, or use gatelight"});
    return apps::kUnavailable;
  }
}
