#pragma once
// The network in the layouts of the kernels. Parameters, gradients, moments and averages all have the packed
// layout, so that they are updated element by element: hidden layers are [inputs][padded outputs], as the
// forward pass reads them, and the last layer is [outputs][padded inputs], as the backward pass does. Each
// layer's biases follow its weights. Padding stays zero.

#include <cstdint>
#include <span>

#include "base/platform/huge_buffer.h"
#include "neural/cpu/kernels.h"
#include "neural/model/model.h"

namespace gatelight::neural::cpu {

/// Indices into the packed layout.
class PackedLayout {
 public:
  explicit PackedLayout(const Model& model);

  std::uint64_t size() const { return size_; }  ///< floats, a multiple of 16
  bool has_biases() const { return model_->parameters.biases; }
  /// Sizes and offsets of the layers, without data.
  const KernelNetwork& network() const { return network_; }
  /// `flat` is the network's part of the flat parameters.
  void pack(std::span<const float> flat, float* packed) const;
  void unpack(const float* packed, std::span<float> flat) const;

 private:
  template <class Visit>
  void each(Visit visit) const;

  const Model* model_;
  KernelNetwork network_ = {};
  std::uint64_t size_ = 0;
};

/// The forms of packed parameters that kernels read beside the packed layout itself.
class PackedNetwork {
 public:
  /// `parameters` have the packed layout. Both must outlive the object.
  PackedNetwork(const PackedLayout& layout, float* parameters);

  /// Follows a change of the parameters begin <= index < end. Ranges may be updated at the same time.
  void update(std::uint64_t begin, std::uint64_t end);
  void update() { update(0, layout_.size()); }
  /// Follows it in the rounded forms. Call it after update(), while nothing reads them.
  void update_rounded();
  const KernelNetwork& kernel() const { return kernel_; }

 private:
  const PackedLayout& layout_;
  KernelNetwork kernel_;
  HugeBuffer<float> floats_;
  HugeBuffer<std::uint16_t> halves_;
};

}  // namespace gatelight::neural::cpu
