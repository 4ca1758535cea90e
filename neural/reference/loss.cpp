#include "neural/reference/loss.h"

#include <numeric>

namespace gatelight::neural::reference {

double luminance(std::span<const double> outputs) {
  if (outputs.size() == 3) return 0.299 * outputs[0] + 0.587 * outputs[1] + 0.114 * outputs[2];
  return std::accumulate(outputs.begin(), outputs.end(), 0.0) / static_cast<double>(outputs.size());
}

double loss_denominator(Loss loss, std::span<const double> outputs) {
  if (loss == Loss::l2) return 1.0;
  const double y = luminance(outputs);
  return y * y + kRelativeLossEpsilon;
}

double loss_value(std::span<const double> outputs, std::span<const double> targets, double denominator) {
  double sum = 0.0;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const double error = outputs[o] - targets[o];
    sum += error * error / denominator;
  }
  return sum;
}

void loss_gradient(std::span<const double> outputs, std::span<const double> targets, double denominator,
                   double scale, std::span<double> gradients) {
  for (std::size_t o = 0; o < outputs.size(); ++o)
    gradients[o] = scale * 2.0 * (outputs[o] - targets[o]) / denominator;
}

}  // namespace gatelight::neural::reference
