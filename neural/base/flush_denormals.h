#pragma once
// Treats floats below 1.2e-38 as zeros. They have no meaning here, and arithmetic with them takes a hundred
// times as long on some processors.

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace gatelight::neural {

/// During its lifetime the thread treats denormal floats as zeros and makes none (FTZ and DAZ); the
/// destructor restores the control word. Threads of oneTBB have the control word of the thread that made
/// their arena, so each task needs its own object.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | kBits);
  }
  ~FlushDenormals() {
    _mm_setcsr((_mm_getcsr() & ~kBits) | (before_ & kBits));
  }
  static bool active() {
    return (_mm_getcsr() & kBits) == kBits;
  }
#else
  FlushDenormals() {}
  ~FlushDenormals() {}
  static bool active() {
    return false;
  }
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__SSE__)
  static constexpr unsigned kBits = 0x8040;  // flush to zero, denormals are zeros
  unsigned before_;
#endif
};

}  // namespace gatelight::neural
