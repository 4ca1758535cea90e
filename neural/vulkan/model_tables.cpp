#include "neural/vulkan/model_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/errors.h"
#include "neural/cpu/adam_table.h"
#include "neural/cpu/kernel_model.h"

namespace gatelight::neural::vulkan {

namespace {

template <class T>
Buffer upload(const Device& device, Transfer& transfer, const std::vector<T>& values, const char* what) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
  if (bytes.size() > device.limits().longest_buffer)
    throw BadConfiguration(fmt::format("{}: {} bytes, expected at most {} on {}", what, bytes.size(),
                                       device.limits().longest_buffer, device.name()));
  Buffer buffer(device, bytes.size(), BufferUse::device);
  transfer.write(buffer, bytes);
  return buffer;
}

// The result is finite, so that its product with a step count is not NaN.
float logarithm(float beta) {
  return static_cast<float>(std::max(std::log(static_cast<double>(beta)), -1e30));
}

AdamBlock adam_block(const TrainingOptions& options) {
  const AdamOptions& adam = options.adam;
  return {adam.beta1,
          adam.beta2,
          adam.learning_rate,
          adam.epsilon,
          adam.l2_network,
          adam.decay_steps,
          logarithm(adam.beta1),
          logarithm(adam.beta2),
          static_cast<float>(1.0 - options.average.decay),
          options.average.ramp,
          cpu::kAdamTableSteps,
          options.average.network ? 1u : 0u};
}

std::uint32_t sources_of(const ModelConfig& config) {
  std::uint32_t sources = config.encoding == FeatureEncoding::gate ? 1u << glsl::kBarycentricsSource : 0u;
  for (std::uint32_t source = 0; source < glsl::kBarycentricsSource; ++source)
    if (uses_input(config, static_cast<InputSource>(source))) sources |= 1u << source;
  return sources;
}

}  // namespace

ModelTables::ModelTables(const Device& device, Transfer& transfer, const Model& model,
                         const TrainingOptions& options, std::uint64_t longest_part)
    : model_(model), options_(options) {
  const GateLayout& gate = model.gate;
  topology_ = Table(device, transfer, gate.topology.size(), 1, longest_part);
  topology_.write(transfer, gate.topology);
  surfaces_ = upload(device, transfer, gate.surfaces, "the table of surfaces");
  levels_ = upload(device, transfer, gate.levels, "the table of levels");
  adam_ = upload(device, transfer, cpu::adam_table(options), "the table of Adam's factors");
}

void ModelTables::describe(ModelBlock& block) const {
  const GateLayout& gate = model_.gate;
  const ParameterLayout& parameters = model_.parameters;
  block.topology = topology_.block();
  block.surfaces = surfaces_.address();
  block.levels = levels_.address();
  block.adam_table = adam_.address();
  block.surface_count = static_cast<std::uint32_t>(gate.surfaces.size());
  block.level_count = model_.levels();
  block.nodes_per_level = model_.nodes_per_level();
  block.per_triangle = gate.storage == NodeStorage::per_triangle ? 1 : 0;
  block.node_count = parameters.node_count;
  block.feature_count = parameters.features;
  block.feature_inputs = parameters.feature_inputs;
  block.inputs = parameters.inputs;
  block.outputs = model_.config.mlp.outputs;
  block.width = model_.config.mlp.width;
  block.hidden_layers = model_.config.mlp.hidden_layers;
  block.biases = parameters.biases ? 1 : 0;
  block.network_count = static_cast<std::uint32_t>(parameters.network_count());
  block.sources = sources_of(model_.config);
  block.inverse_extent = model_.hash_grid.inverse_extent;
  block.max_target = options_.max_target;
  std::ranges::copy(model_.hash_grid.bounds_min, block.bounds_min);
  std::ranges::copy(model_.hash_grid.levels, block.hash_levels);
  const cpu::KernelEncoder encoder = cpu::kernel_encoder(model_);
  block.auxiliary_count = encoder.auxiliary_count;
  for (std::uint32_t i = 0; i < block.auxiliary_count; ++i)
    block.auxiliary[i] = std::bit_cast<AuxiliaryBlock>(encoder.auxiliary[i]);
  block.adam = adam_block(options_);
}

}  // namespace gatelight::neural::vulkan
