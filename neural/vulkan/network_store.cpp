#include "neural/vulkan/network_store.h"

#include <algorithm>
#include <array>

namespace gatelight::neural::vulkan {

namespace {

std::uint64_t to_eights(std::uint64_t n) {
  return (n + 7) / 8 * 8;
}

}  // namespace

std::vector<std::uint32_t> network_constants(const Model& model) {
  const MlpOptions& mlp = model.config.mlp;
  return {model.parameters.inputs, model.parameters.feature_inputs, mlp.width, mlp.hidden_layers, mlp.outputs,
          mlp.biases ? 1u : 0u};
}

std::uint64_t forward_floats(const Model& model) {
  std::uint64_t floats = 0;
  for (const LayerLayout& layer : model.parameters.layers)
    floats += (std::uint64_t{layer.inputs} + 1) * to_eights(layer.outputs);
  return floats;
}

std::uint64_t backward_floats(const Model& model) {
  const ParameterLayout& layout = model.parameters;
  std::uint64_t floats = layout.layers[0].outputs * to_eights(layout.feature_inputs);
  for (std::size_t l = 1; l < layout.layers.size(); ++l)
    floats += std::uint64_t{layout.layers[l].outputs} * layout.layers[l].inputs;
  return floats;
}

NetworkStore::NetworkStore(const Device& device, Transfer& transfer, const Model& model,
                           const TrainingOptions& options)
    : begin_(model.parameters.network),
      count_(model.parameters.network_count()),
      averaging_(options.average.network) {
  const auto floats = [&](std::uint64_t count) { return Buffer(device, 4 * count, BufferUse::device); };
  parameters_ = floats(count_);
  average_ = floats(count_);
  first_ = floats(count_);
  second_ = floats(count_);
  forward_ = floats(forward_floats(model));
  backward_ = floats(backward_floats(model));
  query_forward_ = floats(forward_floats(model));
  progress_ = floats(2);
  for (const Buffer* padded : {&forward_, &backward_, &query_forward_}) transfer.fill(*padded, 0);
}

void NetworkStore::describe(ModelBlock& block) const {
  block.parameters = parameters_.address();
  block.network_average = average_.address();
  block.first_moments = first_.address();
  block.second_moments = second_.address();
  block.forward = forward_.address();
  block.backward = backward_.address();
  block.progress = progress_.address();
}

void NetworkStore::export_to(Transfer& transfer, ModelState& state) const {
  const auto get = [&](const Buffer& from, std::vector<float>& to) {
    transfer.read(from, std::as_writable_bytes(std::span(to).subspan(begin_, count_)));
  };
  get(parameters_, state.parameters);
  get(averaging_ ? average_ : parameters_, state.averages);
  get(first_, state.first_moments);
  get(second_, state.second_moments);
  std::array<std::uint32_t, 2> progress;
  transfer.read(progress_, std::as_writable_bytes(std::span(progress)));
  state.steps = std::uint64_t{progress[1]} << 32 | progress[0];
}

void NetworkStore::import_from(Transfer& transfer, const ModelState& state) {
  const auto put = [&](const std::vector<float>& from, const Buffer& to) {
    transfer.write(to, std::as_bytes(std::span(from).subspan(begin_, count_)));
  };
  put(state.parameters, parameters_);
  put(state.averages, average_);
  put(state.first_moments, first_);
  put(state.second_moments, second_);
  const std::array progress = {static_cast<std::uint32_t>(state.steps),
                               static_cast<std::uint32_t>(state.steps >> 32)};
  transfer.write(progress_, std::as_bytes(std::span(progress)));
}

}  // namespace gatelight::neural::vulkan
