#include "neural/reference/adam.h"

#include <cmath>

#include "neural/learning/adam.h"

namespace gatelight::neural::reference {

double adam(const AdamOptions& options, std::uint64_t t, double parameter, double gradient,
            Moments& moments) {
  const double beta1 = options.beta1, beta2 = options.beta2;
  moments.first = beta1 * moments.first + (1.0 - beta1) * gradient;
  moments.second = beta2 * moments.second + (1.0 - beta2) * gradient * gradient;
  const double m = moments.first / bias_correction(beta1, t);
  const double v = moments.second / bias_correction(beta2, t);
  return parameter - learning_rate_at(options, t) * m / (std::sqrt(v) + options.epsilon);
}

}  // namespace gatelight::neural::reference
