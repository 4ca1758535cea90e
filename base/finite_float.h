#pragma once
// Converts from double to single precision without infinities.

#include <algorithm>
#include <limits>

namespace gatelight {

/// Values beyond the largest float, infinity included, become the largest float. NaN stays NaN.
inline float finite_float(double value) {
  constexpr double kGreatest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kGreatest, kGreatest));
}

}  // namespace gatelight
