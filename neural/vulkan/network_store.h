#pragma once
// The network's parameters, their optimiser state and the step count on the device.

#include <vector>

#include "neural/model/state.h"
#include "neural/vulkan/blocks.h"
#include "neural/vulkan/transfer.h"

namespace gatelight::neural::vulkan {

/// The first specialization constants of shaders that include shaders/network.glsl.
std::vector<std::uint32_t> network_constants(const Model& model);

/// Number of floats of the packed layouts in shaders/network.glsl.
std::uint64_t forward_floats(const Model& model);
std::uint64_t backward_floats(const Model& model);

class NetworkStore {
 public:
  NetworkStore(const Device& device, Transfer& transfer, const Model& model, const TrainingOptions& options);

  void describe(ModelBlock& block) const;
  Address forward() const { return forward_.address(); }
  Address query_forward() const { return query_forward_.address(); }
  bool averages() const { return averaging_; }

  /// Writes the network's part of the arrays, which must have their sizes, and the step count.
  void export_to(Transfer& transfer, ModelState& state) const;
  void import_from(Transfer& transfer, const ModelState& state);

  std::uint64_t parameter_bytes() const { return parameters_.bytes(); }
  std::uint64_t optimizer_bytes() const { return average_.bytes() + first_.bytes() + second_.bytes(); }

 private:
  std::uint64_t begin_, count_;
  bool averaging_;
  Buffer parameters_, average_, first_, second_, forward_, backward_, query_forward_, progress_;
};

}  // namespace gatelight::neural::vulkan
