#pragma once
// Treats floats below 1.2e-38 as zeros. They have no meaning here, and arithmetic with them takes a hundred
// times as long on some processors.

#include <cstdint>

namespace gatelight {

/// The processor's control word of floating-point arithmetic, of this thread.
std::uint64_t float_control();
void set_float_control(std::uint64_t word);
/// Its bits that flush denormals (FTZ and DAZ); 0 for processors that are not known, which keep denormals.
extern const std::uint64_t kFlushBits;

/// During its lifetime the thread treats denormal floats as zeros and makes none; the
/// destructor restores the control word. Threads of oneTBB have the control word of the thread that made
/// their arena, so each task needs its own object.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  std::uint64_t before_;
};

}  // namespace gatelight
