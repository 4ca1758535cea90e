#include "neural/model/model.h"
#include "neural/layout/build_gate_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/errors.h"
#include "base/require.h"

namespace gatelight::neural {

namespace {

void check_mlp(const MlpOptions& mlp) {
  require(mlp.width == 16 || mlp.width == 32 || mlp.width == 64 || mlp.width == 128, "hidden", mlp.width,
          "16, 32, 64 or 128");
  require(mlp.hidden_layers >= 1 && mlp.hidden_layers < kMaxLayers, "layers", mlp.hidden_layers, "1 to 5");
  require(mlp.outputs >= 1 && mlp.outputs <= 16, "outputs", mlp.outputs, "1 to 16");
  require(mlp.leaky_slope >= 0.0f && mlp.leaky_slope <= 1.0f, "leaky-slope", mlp.leaky_slope, "0 to 1");
}

void check_auxiliary(const AuxiliaryInput& input) {
  if (input.encoding == InputEncoding::one_blob)
    require(std::has_single_bit(input.size) && input.size >= 2 && input.size <= 64, "one-blob-bins",
            input.size, "a power of two from 2 to 64");
}

}  // namespace

std::uint32_t coordinate_count(const AuxiliaryInput& input) {
  const bool spherical = input.source == InputSource::direction || input.source == InputSource::normal;
  if (input.source == InputSource::roughness) return 1;
  return spherical && input.encoding == InputEncoding::one_blob ? 2 : 3;
}

std::uint32_t input_count(const AuxiliaryInput& input) {
  return coordinate_count(input) * (input.encoding == InputEncoding::one_blob ? input.size : 1);
}

std::vector<AuxiliaryInput> composite_inputs(const RequiredInputs& required, std::uint32_t bins) {
  std::vector<AuxiliaryInput> inputs;
  if (required.direction) inputs.push_back({InputSource::direction, InputEncoding::one_blob, bins});
  if (required.normal) inputs.push_back({InputSource::normal, InputEncoding::one_blob, bins});
  if (required.albedo) inputs.push_back({InputSource::albedo, InputEncoding::identity, 0});
  if (required.roughness) inputs.push_back({InputSource::roughness, InputEncoding::identity, 0});
  return inputs;
}

bool uses_input(const ModelConfig& config, InputSource source) {
  if (source == InputSource::position && config.encoding == FeatureEncoding::hash_grid) return true;
  return std::any_of(config.auxiliary.begin(), config.auxiliary.end(),
                     [&](const AuxiliaryInput& input) { return input.source == source; });
}

std::uint32_t Model::levels() const {
  if (config.encoding == FeatureEncoding::gate) return gate.stack;
  return static_cast<std::uint32_t>(hash_grid.levels.size());
}

std::uint32_t Model::nodes_per_level() const {
  return config.encoding == FeatureEncoding::gate ? 3 : 8;
}

std::uint32_t Model::nodes_per_point() const {
  return levels() * nodes_per_level();
}

std::shared_ptr<const Model> make_model(const ModelConfig& config, const SurfaceLayout& surfaces) {
  check_mlp(config.mlp);
  require(config.auxiliary.size() <= kMaxAuxiliaryInputs, "auxiliary-inputs", config.auxiliary.size(),
          "at most 16");
  auto model = std::make_shared<Model>();
  model->config = config;
  ParameterLayout& layout = model->parameters;
  if (config.encoding == FeatureEncoding::gate) {
    model->gate = build_gate_layout(surfaces, config.gate);
    layout.node_count = model->gate.node_count;
    layout.features = model->gate.features;
  } else if (config.encoding == FeatureEncoding::hash_grid) {
    model->hash_grid = build_hash_grid_layout(config.hash_grid);
    layout.node_count = model->hash_grid.node_count;
    layout.features = model->hash_grid.features;
  }
  if (config.encoding != FeatureEncoding::hash_grid && uses_input(config, InputSource::position))
    model->hash_grid = build_position_mapping(config.hash_grid);
  layout.feature_inputs = model->levels() * layout.features;
  layout.inputs = layout.feature_inputs;
  for (const AuxiliaryInput& input : config.auxiliary) {
    check_auxiliary(input);
    layout.inputs += input_count(input);
  }
  require(layout.inputs >= 1 && layout.inputs <= kMaxInputs, "network-inputs", layout.inputs, "1 to 256");

  layout.network = std::uint64_t{layout.node_count} * layout.features;
  layout.count = layout.network;
  layout.biases = config.mlp.biases;
  for (std::uint32_t i = 0; i <= config.mlp.hidden_layers; ++i) {
    LayerLayout layer;
    layer.inputs = i == 0 ? layout.inputs : config.mlp.width;
    layer.outputs = i == config.mlp.hidden_layers ? config.mlp.outputs : config.mlp.width;
    layer.weights = layout.count;
    layer.biases = layer.weights + std::uint64_t{layer.inputs} * layer.outputs;
    layout.count = layer.biases + (layout.biases ? layer.outputs : 0);
    layout.layers.push_back(layer);
  }
  return model;
}

}  // namespace gatelight::neural
