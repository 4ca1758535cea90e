#pragma once
// From a point to the network's inputs: the interpolated features of all levels in a row, then the auxiliary
// inputs in the order of the configuration.

#include <span>
#include <vector>

#include "neural/reference/node_weight.h"
#include "neural/reference/point.h"

namespace gatelight::neural::reference {

/// The nodes that the point reads, nodes_per_level() for each level in turn. Empty where nothing is stored.
std::vector<NodeWeight> encoding_nodes(const Model& model, const Point& point);

/// z = sum w_t z_t for each level (paper, section 3.1), then the auxiliary inputs. `parameters` are the
/// model's, of which the features are read.
std::vector<double> encode(const Model& model, std::span<const double> parameters, const Point& point);

/// dE/dz_t += w_t dE/dz. `gradients` are laid out like the parameters.
void encode_backward(const Model& model, const Point& point, std::span<const double> input_gradients,
                     std::span<double> gradients);

}  // namespace gatelight::neural::reference
