#pragma once
// Random points of the unit square.

#include "base/math.h"
#include "tests/support/statistics.h"

namespace gatelight::testing {

/// Draws one number after the other: compilers evaluate arguments in orders of their own.
inline Vec2 next_2d(Random& random) {
  const float u = random.uniform_float();
  return {u, random.uniform_float()};
}

}  // namespace gatelight::testing
