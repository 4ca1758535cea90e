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

float from_bf16(std::uint16_t half) {
  return std::bit_cast<float>(std::uint32_t{half} << 16);
}

// The place of a weight in KernelLayer::forward_groups.
std::uint32_t group_index(std::uint32_t input, std::uint32_t output) {
  return (input / 16 * 4 + input % 4) * 16 + input % 16 / 4 * 4 + output;
}

}  // namespace

PackedLayout::PackedLayout(const Model& model) : model_(&model) {
  const ParameterLayout& layout = model.parameters;
  KernelNetwork& n = network_;
  n.layer_count = static_cast<std::uint32_t>(layout.layers.size());
  n.inputs = layout.inputs;
  n.feature_inputs = layout.feature_inputs;
  n.input_stride = std::max(16u, std::bit_ceil(layout.inputs));
  n.width = model.config.mlp.width;
  n.outputs = model.config.mlp.outputs;
  n.slope = model.config.mlp.leaky_slope;
  for (std::uint32_t l = 0; l < n.layer_count; ++l) {
    KernelLayer& layer = n.layers[l];
    layer.inputs = layout.layers[l].inputs;
    layer.outputs = layout.layers[l].outputs;
    layer.padded_inputs = padded(l == 0 ? std::max(layout.feature_inputs, 1u) : layer.inputs);
    layer.padded_outputs = padded(layer.outputs);
    layer.gradient = size_;
    size_ += l + 1 == n.layer_count ? std::uint64_t{(layer.outputs + 3) / 4 * 4} * layer.padded_inputs
                                    : std::uint64_t{layer.inputs} * layer.padded_outputs;
    layer.bias_gradient = size_;
    size_ += layer.padded_outputs;
  }
}

// Calls visit(packed index, flat index) for each parameter.
template <class Visit>
void PackedLayout::each(Visit visit) const {
  const ParameterLayout& layout = model_->parameters;
  for (std::uint32_t l = 0; l < network_.layer_count; ++l) {
    const KernelLayer& layer = network_.layers[l];
    const bool last = l + 1 == network_.layer_count;
    const std::uint64_t weights = layout.layers[l].weights - layout.network;
    const std::uint64_t biases = layout.layers[l].biases - layout.network;
    for (std::uint32_t o = 0; o < layer.outputs; ++o) {
      for (std::uint32_t i = 0; i < layer.inputs; ++i) {
        visit(layer.gradient + (last ? std::uint64_t{o} * layer.padded_inputs + i
                                     : std::uint64_t{i} * layer.padded_outputs + o),
              weights + std::uint64_t{o} * layer.inputs + i);
      }
      if (layout.biases) visit(layer.bias_gradient + o, biases + o);
    }
  }
}

void PackedLayout::pack(std::span<const float> flat, float* packed) const {
  std::fill_n(packed, size_, 0.0f);
  each([&](std::uint64_t to, std::uint64_t from) { packed[to] = flat[from]; });
}

void PackedLayout::unpack(const float* packed, std::span<float> flat) const {
  each([&](std::uint64_t from, std::uint64_t to) { flat[to] = packed[from]; });
}

PackedNetwork::PackedNetwork(const PackedLayout& layout, float* parameters)
    : layout_(layout), kernel_(layout.network()) {
  // The packed weights are the forward form of hidden layers and the backward form of the last one.
  std::uint64_t floats = 0, halves = 0;
  const auto take_floats = [&](std::uint64_t count) {
    const std::uint64_t at = floats;
    floats += count;
    return at;
  };
  struct Offsets {
    std::uint64_t other, rounded, groups, groups_rounded, halves;
  };
  Offsets offsets[kMaxKernelLayers] = {};
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    const KernelLayer& layer = kernel_.layers[l];
    const bool last = l + 1 == kernel_.layer_count, groups = last && layer.outputs <= 4;
    const std::uint64_t forward = std::uint64_t{layer.inputs} * layer.padded_outputs;
    Offsets& at = offsets[l];
    at.other = take_floats(last ? forward : std::uint64_t{layer.outputs} * layer.padded_inputs);
    at.rounded = take_floats(forward);
    at.groups = take_floats(groups ? 4 * std::uint64_t{layer.inputs} : 0);
    at.groups_rounded = take_floats(groups ? 4 * std::uint64_t{layer.inputs} : 0);
    at.halves = halves;
    halves += std::uint64_t{layer.inputs + 1} / 2 * 2 * layer.padded_outputs;
  }
  floats_ = HugeBuffer<float>(floats);
  halves_ = HugeBuffer<std::uint16_t>(halves);
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    KernelLayer& layer = kernel_.layers[l];
    const bool last = l + 1 == kernel_.layer_count;
    float* const packed = parameters + layer.gradient;
    float* const other = floats_.data() + offsets[l].other;
    layer.forward = last ? other : packed;
    layer.backward = last ? packed : other;
    layer.biases = parameters + layer.bias_gradient;
    layer.forward_rounded = floats_.data() + offsets[l].rounded;
    layer.forward_bf16 = halves_.data() + offsets[l].halves;
    if (!last || layer.outputs > 4) continue;
    layer.forward_groups = floats_.data() + offsets[l].groups;
    layer.forward_groups_rounded = floats_.data() + offsets[l].groups_rounded;
  }
}

void PackedNetwork::update(std::uint64_t begin, std::uint64_t end) {
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    const KernelLayer& layer = kernel_.layers[l];
    const bool last = l + 1 == kernel_.layer_count;
    const std::uint32_t columns = last ? layer.padded_inputs : layer.padded_outputs;
    const std::uint32_t used = last ? layer.inputs : layer.outputs;
    // The backward form of the first layer has features only.
    const std::uint32_t rows = last ? layer.outputs : l == 0 ? kernel_.feature_inputs : layer.inputs;
    const float* const packed = last ? layer.backward : layer.forward;
    const std::uint64_t first = std::max(begin, layer.gradient);
    const std::uint64_t after = std::min(end, layer.gradient + std::uint64_t{rows} * columns);
    for (std::uint64_t at = first; at < after; ++at) {
      const auto row = static_cast<std::uint32_t>((at - layer.gradient) / columns);
      const auto column = static_cast<std::uint32_t>((at - layer.gradient) % columns);
      if (column >= used) continue;
      const float w = packed[at - layer.gradient];
      if (!last) {
        layer.backward[std::uint64_t{column} * layer.padded_inputs + row] = w;
        continue;
      }
      layer.forward[std::uint64_t{column} * layer.padded_outputs + row] = w;
      if (layer.forward_groups != nullptr) layer.forward_groups[group_index(column, row)] = w;
    }
  }
}

void PackedNetwork::update_rounded() {
  for (std::uint32_t l = 0; l < kernel_.layer_count; ++l) {
    const KernelLayer& layer = kernel_.layers[l];
    for (std::uint32_t i = 0; i < layer.inputs; ++i) {
      for (std::uint32_t o = 0; o < layer.outputs; ++o) {
        const std::uint64_t at = std::uint64_t{i} * layer.padded_outputs + o;
        const std::uint16_t half = to_bf16(layer.forward[at]);
        layer.forward_rounded[at] = from_bf16(half);
        layer.forward_bf16[(std::uint64_t{i / 2} * layer.padded_outputs + o) * 2 + i % 2] = half;
        if (layer.forward_groups_rounded != nullptr)
          layer.forward_groups_rounded[group_index(i, o)] = from_bf16(half);
      }
    }
  }
}

}  // namespace gatelight::neural::cpu
