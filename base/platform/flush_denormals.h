#pragma once
// Treats floats below 1.2e-38 as zeros. They have no meaning here, and arithmetic with them takes a hundred
// times as long on some processors.

namespace gatelight {

/// During its lifetime the thread treats denormal floats as zeros and makes none (FTZ and DAZ); the
/// destructor restores the control word. Threads of oneTBB have the control word of the thread that made
/// their arena, so each task needs its own object.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

}  // namespace gatelight
