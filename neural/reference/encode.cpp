#include "neural/reference/encode.h"

#include "neural/layout/mesh_colors.h"
#include "neural/reference/auxiliary.h"
#include "neural/reference/hash_grid_encoding.h"

namespace gatelight::neural::reference {

namespace {

std::vector<NodeWeight> gate_nodes(const GateLayout& layout, const Point& point) {
  std::vector<NodeWeight> nodes;
  for (std::uint32_t level = 0; level < layout.stack; ++level) {
    const auto sample = gate_lookup<double>(layout, point.surface, level, point.triangle, point.barycentrics);
    if (!sample) return {};
    for (std::size_t t = 0; t < 3; ++t) nodes.push_back({sample->nodes[t], sample->weights[t]});
  }
  return nodes;
}

}  // namespace

std::vector<NodeWeight> encoding_nodes(const Model& model, const Point& point) {
  switch (model.config.encoding) {
    case FeatureEncoding::gate:
      return gate_nodes(model.gate, point);
    case FeatureEncoding::hash_grid:
      return hash_grid_nodes(model.hash_grid, point.position);
    case FeatureEncoding::none:
      break;
  }
  return {};
}

std::vector<double> encode(const Model& model, std::span<const double> parameters, const Point& point) {
  const ParameterLayout& layout = model.parameters;
  std::vector<double> inputs(layout.feature_inputs, 0.0);
  const std::vector<NodeWeight> nodes = encoding_nodes(model, point);
  for (std::size_t t = 0; t < nodes.size(); ++t) {
    const std::size_t level = t / model.nodes_per_level();
    for (std::size_t l = 0; l < layout.features; ++l)
      inputs[level * layout.features + l] +=
          nodes[t].weight * parameters[std::size_t{nodes[t].node} * layout.features + l];
  }
  for (const AuxiliaryInput& input : model.config.auxiliary) append_auxiliary(input, point, inputs);
  return inputs;
}

void encode_backward(const Model& model, const Point& point, std::span<const double> input_gradients,
                     std::span<double> gradients) {
  const std::size_t features = model.parameters.features;
  const std::vector<NodeWeight> nodes = encoding_nodes(model, point);
  for (std::size_t t = 0; t < nodes.size(); ++t) {
    const std::size_t level = t / model.nodes_per_level();
    for (std::size_t l = 0; l < features; ++l)
      gradients[std::size_t{nodes[t].node} * features + l] +=
          nodes[t].weight * input_gradients[level * features + l];
  }
}

}  // namespace gatelight::neural::reference
