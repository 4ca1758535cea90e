#include <exception>

#include "apps/command_line.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/signals.h"
#include "base/platform/flush_denormals.h"
#include "base/platform/numa.h"

int main(int argc, char** argv) {
  // TBB copies this state to its threads at its first use.
  const gatelight::FlushDenormals flush;
  gatelight::interleave_memory();
  std::set_terminate(gatelight::apps::end_program);
  gatelight::apps::ignore_write_signals();
  return gatelight::apps::run(argc, argv);
}
