#include "base/platform/flush_denormals.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace gatelight {

#if defined(__x86_64__)
const std::uint64_t kFlushBits = 0x8040;  // flush to zero, denormals are zeros
std::uint64_t float_control() {
  return _mm_getcsr();
}
void set_float_control(std::uint64_t word) {
  _mm_setcsr(static_cast<unsigned>(word));
}
#elif defined(__aarch64__)
const std::uint64_t kFlushBits = 1u << 24;  // FZ of the register FPCR, for inputs and results
std::uint64_t float_control() {
  std::uint64_t word;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return word;
}
void set_float_control(std::uint64_t word) {
  asm volatile("msr fpcr, %0" : : "r"(word));
}
#else
const std::uint64_t kFlushBits = 0;
std::uint64_t float_control() {
  return 0;
}
void set_float_control(std::uint64_t) {}
#endif

FlushDenormals::FlushDenormals() : before_(float_control()) {
  set_float_control(before_ | kFlushBits);
}

FlushDenormals::~FlushDenormals() {
  set_float_control((float_control() & ~kFlushBits) | (before_ & kFlushBits));
}

}  // namespace gatelight
