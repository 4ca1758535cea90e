#include "neural/cpu/packed_network.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gatelight::neural::cpu {

namespace {

std::uint32_t padded(std::uint32_t n) {
  return (n + 15) / 16 * 16;
}

// Rounds to nearest even; values that are not finite stay so.
std::uint16_t to_bf16(float value) {
  const std::uint32_t word = std::bit_cast<std::uint32_t>(value);
  if (!std::isfinite(value)) return static_cast<std::uint16_t>(word >> 16 | (std::isnan(value) ? 0x40u : 0u));
  return static_cast<std::uint16_t>((word + 0x7fffu + (word >> 16 & 1u)) >> 16);
}

}  // namespace

PackedNetwork::PackedNetwork(const Model& model) : model_(&model) {
  const ParameterLayout& layout = model.parameters;
  kernel_.layer_count = static_cast<std::uint32_t>(layout.layers.size());
  kernel_.inputs = layout.inputs;
  kernel_.feature_inputs = layout.feature_inputs;
  kernel_.input_stride = std::max(16u, std::bit_ceil(layout.inputs));
  kernel_.width = model.config.mlp.width;
  kernel_.outputs = model.config.mlp.outputs;
  kernel_.slope = model.config.mlp.leaky_slope;

  std::uint64_t floats = 0, halves = 0;
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    KernelLayer& layer = kernel_.layers[l];
    layer.inputs = layout.layers[l].inputs;
    layer.outputs = layout.layers[l].outputs;
    layer.padded_inputs = padded(l == 0 ? std::max(layout.feature_inputs, 1u) : layer.inputs);
    layer.padded_outputs = padded(layer.outputs);
    const bool last = l + 1 == kernel_.layer_count;
    layer.gradient = gradient_size_;
    gradient_size_ += last ? std::uint64_t{(layer.outputs + 3) / 4 * 4} * layer.padded_inputs
                           : std::uint64_t{layer.inputs} * layer.padded_outputs;
    layer.bias_gradient = gradient_size_;
    gradient_size_ += layer.padded_outputs;
    const std::uint64_t forward = std::uint64_t{layer.inputs} * layer.padded_outputs;
    floats += 2 * forward + std::uint64_t{layer.outputs} * layer.padded_inputs + layer.padded_outputs;
    if (last && layer.outputs <= 4) floats += 2 * 4 * std::uint64_t{layer.inputs};
    halves += std::uint64_t{layer.inputs + 1} * layer.padded_outputs;
  }
  gradient_size_ = (gradient_size_ + 15) / 16 * 16;
  floats_ = HugeBuffer<float>(floats);
  halves_ = HugeBuffer<std::uint16_t>(halves);
  float* f = floats_.data();
  std::uint16_t* h = halves_.data();
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    KernelLayer& layer = kernel_.layers[l];
    const std::uint64_t forward = std::uint64_t{layer.inputs} * layer.padded_outputs;
    layer.forward = f;
    layer.forward_rounded = f + forward;
    layer.backward = layer.forward_rounded + forward;
    layer.biases = layer.backward + std::uint64_t{layer.outputs} * layer.padded_inputs;
    layer.forward_bf16 = h;
    f = layer.biases + layer.padded_outputs;
    if (l + 1 == kernel_.layer_count && layer.outputs <= 4) {
      layer.forward_groups = f;
      layer.forward_groups_rounded = f + 4 * std::uint64_t{layer.inputs};
      f += 8 * std::uint64_t{layer.inputs};
    }
    h += std::uint64_t{layer.inputs + 1} / 2 * 2 * layer.padded_outputs;
  }
}

void PackedNetwork::pack(std::span<const float> network) {
  const ParameterLayout& layout = model_->parameters;
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    const KernelLayer& layer = kernel_.layers[l];
    const float* weights = network.data() + (layout.layers[l].weights - layout.network);
    const float* biases = network.data() + (layout.layers[l].biases - layout.network);
    const std::uint32_t backward_inputs = l == 0 ? layout.feature_inputs : layer.inputs;
    for (std::uint32_t o = 0; o < layer.outputs; ++o)
      for (std::uint32_t i = 0; i < layer.inputs; ++i) {
        const float w = weights[std::uint64_t{o} * layer.inputs + i];
        const std::uint16_t half = to_bf16(w);
        layer.forward[std::uint64_t{i} * layer.padded_outputs + o] = w;
        layer.forward_rounded[std::uint64_t{i} * layer.padded_outputs + o] =
            std::bit_cast<float>(std::uint32_t{half} << 16);
        layer.forward_bf16[(std::uint64_t{i / 2} * layer.padded_outputs + o) * 2 + i % 2] = half;
        if (layer.forward_groups != nullptr) {
          const std::uint32_t at = (i / 16 * 4 + i % 4) * 16 + i % 16 / 4 * 4 + o;
          layer.forward_groups[at] = w;
          layer.forward_groups_rounded[at] = std::bit_cast<float>(std::uint32_t{half} << 16);
        }
        if (i < backward_inputs) layer.backward[std::uint64_t{o} * layer.padded_inputs + i] = w;
      }
    if (layout.biases)
      for (std::uint32_t o = 0; o < layer.outputs; ++o) layer.biases[o] = biases[o];
  }
}

void PackedNetwork::unpack_gradients(const float* packed, std::span<float> network) const {
  const ParameterLayout& layout = model_->parameters;
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    const KernelLayer& layer = kernel_.layers[l];
    const bool last = l + 1 == kernel_.layer_count;
    float* weights = network.data() + (layout.layers[l].weights - layout.network);
    const float* g = packed + layer.gradient;
    for (std::uint32_t o = 0; o < layer.outputs; ++o)
      for (std::uint32_t i = 0; i < layer.inputs; ++i)
        weights[std::uint64_t{o} * layer.inputs + i] = last ? g[std::uint64_t{o} * layer.padded_inputs + i]
                                                            : g[std::uint64_t{i} * layer.padded_outputs + o];
    if (layout.biases)
      for (std::uint32_t o = 0; o < layer.outputs; ++o)
        network[layout.layers[l].biases - layout.network + o] = packed[layer.bias_gradient + o];
  }
}

}  // namespace gatelight::neural::cpu
