#pragma once
// Measures wall time.

#include <chrono>

namespace gatelight {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace gatelight
