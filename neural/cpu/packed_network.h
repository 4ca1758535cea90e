#pragma once
// The network's parameters in the layouts of the kernels: padded, also transposed, and in bf16.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "neural/cpu/huge_buffer.h"
#include "neural/cpu/kernels.h"
#include "neural/model/model.h"

namespace gatelight::neural::cpu {

class PackedNetwork {
 public:
  explicit PackedNetwork(const Model& model);

  /// Packs `network`, the network's part of the flat parameters.
  void pack(std::span<const float> network);

  const KernelNetwork& kernel() const { return kernel_; }
  /// Number of floats of a chunk's gradients.
  std::uint64_t gradient_size() const { return gradient_size_; }
  /// Copies a chunk's gradients to the layout of the flat parameters.
  void unpack_gradients(const float* packed, std::span<float> network) const;

 private:
  const Model* model_;
  KernelNetwork kernel_ = {};
  std::uint64_t gradient_size_ = 0;
  HugeBuffer<float> floats_;
  HugeBuffer<std::uint16_t> halves_;
};

}  // namespace gatelight::neural::cpu
