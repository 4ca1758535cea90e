#include "neural/reference/one_blob.h"

#include <cmath>

namespace gatelight::neural::reference {

double quartic_cdf(double u) {
  if (u <= -1.0) return 0.0;
  if (u >= 1.0) return 1.0;
  const double squared = u * u;
  return 15.0 / 16.0 * u * (1.0 - 2.0 / 3.0 * squared + 1.0 / 5.0 * squared * squared) + 0.5;
}

void one_blob(double x, bool wraps, std::span<double> bins) {
  const double k = static_cast<double>(bins.size());
  const double place = wraps ? x - std::floor(x) : x;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const auto part = [&](double centre) {
      const double from_left = static_cast<double>(b) - k * centre;
      return quartic_cdf(from_left + 1.0) - quartic_cdf(from_left);
    };
    bins[b] = part(place);
    if (wraps) bins[b] += part(place - 1.0) + part(place + 1.0);
  }
}

}  // namespace gatelight::neural::reference
