// One target as libFuzzer calls it. GATELIGHT_FUZZ_TARGET names it.

#include <oneapi/tbb/global_control.h>

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/targets.h"

// OpenImageIO's plugins are deleted by another type than they were made as.
extern "C" const char* __asan_default_options() {
  return "new_delete_type_mismatch=0:allocator_may_return_null=0";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // One thread: what an input covers does not depend on the schedule.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  gatelight::fuzz::GATELIGHT_FUZZ_TARGET({data, size});
  return 0;
}
