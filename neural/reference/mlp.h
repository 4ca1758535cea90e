#pragma once
// The multilayer perceptron: y = W x + b, with leaky ReLU after all layers but the last.

#include <span>
#include <vector>

#include "neural/model/model.h"

namespace gatelight::neural::reference {

/// The network's inputs, then each layer's outputs after its activation.
using Activations = std::vector<std::vector<double>>;

Activations forward(const Model& model, std::span<const double> parameters, std::span<const double> inputs);

/// Adds dE/dW and dE/db to `gradients`, which has the layout of the parameters, and returns dE/dx for the
/// inputs x. The activation's derivative at zero is the slope.
std::vector<double> backward(const Model& model, std::span<const double> parameters,
                             const Activations& activations, std::span<const double> output_gradients,
                             std::span<double> gradients);

}  // namespace gatelight::neural::reference
