#include "renderer/run/error_checks.h"

#include <cmath>
#include <initializer_list>
#include <limits>

namespace gatelight::renderer {

int next_check(int samples) {
  constexpr double kFirst = 4.0;
  for (double check = kFirst; check < std::numeric_limits<int>::max(); check *= 2.0) {
    for (const double at : {check, std::round(check * std::sqrt(2.0))}) {
      if (at > samples) return static_cast<int>(at);
    }
  }
  return std::numeric_limits<int>::max();
}

}  // namespace gatelight::renderer
