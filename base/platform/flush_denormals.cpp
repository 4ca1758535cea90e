#include "base/platform/flush_denormals.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace gatelight {
namespace {

#if defined(__x86_64__)
constexpr unsigned kBits = 0x8040;  // flush to zero, denormals are zeros
unsigned control_word() {
  return _mm_getcsr();
}
void set_control_word(unsigned word) {
  _mm_setcsr(word);
}
#else
// Other processors keep their denormals, which costs only time.
constexpr unsigned kBits = 0;
unsigned control_word() {
  return 0;
}
void set_control_word(unsigned) {}
#endif

}  // namespace

FlushDenormals::FlushDenormals() : before_(control_word()) {
  set_control_word(before_ | kBits);
}

FlushDenormals::~FlushDenormals() {
  set_control_word((control_word() & ~kBits) | (before_ & kBits));
}

}  // namespace gatelight
