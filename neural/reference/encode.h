#pragma once
// Encodes a point as network inputs: the interpolated features of all levels, then the auxiliary inputs in
// the order of the configuration.

#include <span>
#include <vector>

#include "neural/reference/node_weight.h"
#include "neural/reference/point.h"

namespace gatelight::neural::reference {

/// The nodes that the point reads, nodes_per_level() for each level. Empty without storage.
std::vector<NodeWeight> encoding_nodes(const Model& model, const Point& point);

/// z = sum w_t z_t for each level (paper, section 3.1), then the auxiliary inputs. `parameters` are all
/// parameters of the model.
std::vector<double> encode(const Model& model, std::span<const double> parameters, const Point& point);

/// Adds w_t dE/dz to dE/dz_t. `gradients` has the layout of the parameters.
void encode_backward(const Model& model, const Point& point, std::span<const double> input_gradients,
                     std::span<double> gradients);

}  // namespace gatelight::neural::reference
