#include <pmmintrin.h>
#include <xmmintrin.h>

#include <exception>

#include "apps/command_line.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/signals.h"

int main(int argc, char** argv) {
  // Denormals cost a hundred cycles each and mean nothing here. TBB copies this state to its threads at its
  // first use.
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  std::set_terminate(gatelight::apps::end_program);
  gatelight::apps::ignore_write_signals();
  return gatelight::apps::run(argc, argv);
}
