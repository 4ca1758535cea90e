#include "neural/reference/mlp.h"

namespace gatelight::neural::reference {

Activations forward(const Model& model, std::span<const double> parameters, std::span<const double> inputs) {
  const ParameterLayout& layout = model.parameters;
  const double slope = model.config.mlp.leaky_slope;
  Activations activations = {{inputs.begin(), inputs.end()}};
  for (std::size_t n = 0; n < layout.layers.size(); ++n) {
    const LayerLayout& layer = layout.layers[n];
    const bool last = n + 1 == layout.layers.size();
    const std::vector<double>& x = activations.back();
    std::vector<double> y(layer.outputs);
    for (std::size_t o = 0; o < layer.outputs; ++o) {
      double sum = layout.biases ? parameters[layer.biases + o] : 0.0;
      for (std::size_t i = 0; i < layer.inputs; ++i)
        sum += parameters[layer.weights + o * layer.inputs + i] * x[i];
      y[o] = last || sum > 0.0 ? sum : slope * sum;
    }
    activations.push_back(std::move(y));
  }
  return activations;
}

std::vector<double> backward(const Model& model, std::span<const double> parameters,
                             const Activations& activations, std::span<const double> output_gradients,
                             std::span<double> gradients) {
  const ParameterLayout& layout = model.parameters;
  const double slope = model.config.mlp.leaky_slope;
  std::vector<double> dy(output_gradients.begin(), output_gradients.end());
  for (std::size_t n = layout.layers.size(); n-- > 0;) {
    const LayerLayout& layer = layout.layers[n];
    const std::vector<double>& x = activations[n];
    std::vector<double> dx(layer.inputs, 0.0);
    for (std::size_t o = 0; o < layer.outputs; ++o) {
      if (layout.biases) gradients[layer.biases + o] += dy[o];
      for (std::size_t i = 0; i < layer.inputs; ++i) {
        const std::size_t weight = layer.weights + o * layer.inputs + i;
        gradients[weight] += dy[o] * x[i];
        dx[i] += dy[o] * parameters[weight];
      }
    }
    // Back through the activation that produced x. It keeps the sign; with slope 0 a negative value becomes x
    // = 0.
    if (n > 0)
      for (std::size_t i = 0; i < layer.inputs; ++i) dx[i] *= x[i] > 0.0 ? 1.0 : slope;
    dy = std::move(dx);
  }
  return dy;
}

}  // namespace gatelight::neural::reference
