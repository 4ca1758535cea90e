#pragma once
// Random numbers for the tests of `neural`: a key and a counter, hashed.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/random.h"
#include "neural/model/batch.h"

namespace gatelight::neural::testing {

struct Random {
  std::uint64_t key = 0;
  std::uint64_t counter = 0;

  float unit() { return uniform_float(key, counter++); }  ///< in [0,1)
  float between(float low, float high) { return low + (high - low) * unit(); }
  std::uint32_t below(std::uint32_t count) {
    return std::min(static_cast<std::uint32_t>(unit() * static_cast<float>(count)), count - 1);
  }
  Float3 direction() {
    const float z = between(-1, 1), phi = between(0, 6.2831853f), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
};

}  // namespace gatelight::neural::testing
