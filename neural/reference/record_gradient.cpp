#include "neural/reference/record_gradient.h"

#include "neural/reference/encode.h"
#include "neural/reference/loss.h"
#include "neural/reference/mlp.h"

namespace gatelight::neural::reference {

std::vector<double> evaluate(const Model& model, std::span<const double> parameters, const Point& point) {
  return forward(model, parameters, encode(model, parameters, point)).back();
}

double add_record_gradient(const Model& model, Loss loss, std::span<const double> parameters,
                           const Point& point, std::span<const double> targets, double scale,
                           std::span<double> gradients) {
  const Activations activations = forward(model, parameters, encode(model, parameters, point));
  const std::vector<double>& outputs = activations.back();
  const double denominator = loss_denominator(loss, outputs);
  std::vector<double> output_gradients(outputs.size());
  loss_gradient(outputs, targets, denominator, scale, output_gradients);
  const std::vector<double> input_gradients =
      backward(model, parameters, activations, output_gradients, gradients);
  encode_backward(model, point, input_gradients, gradients);
  return loss_value(outputs, targets, denominator);
}

}  // namespace gatelight::neural::reference
