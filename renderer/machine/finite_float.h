#pragma once
// From double to single precision without making infinities.

#include <algorithm>
#include <limits>

namespace gatelight::renderer {

/// What lies beyond the greatest float, infinity too, becomes that; NaN stays NaN.
inline float finite_float(double value) {
  constexpr double kGreatest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kGreatest, kGreatest));
}

}  // namespace gatelight::renderer
