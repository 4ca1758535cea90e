#include "renderer/driver/error_checks.h"

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

namespace gatelight::renderer {

int next_check(int samples) {
  constexpr std::int64_t kFirst = 4;
  for (std::int64_t check = kFirst; check < std::numeric_limits<int>::max(); check *= 2) {
    for (const std::int64_t at : {check, std::lround(static_cast<double>(check) * std::sqrt(2.0))}) {
      if (at > samples) return static_cast<int>(at);
    }
  }
  return std::numeric_limits<int>::max();
}

}  // namespace gatelight::renderer
