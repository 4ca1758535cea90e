#pragma once
// The network's parameters, what Adam keeps of them, and the count of steps, on the device.

#include <vector>

#include "neural/model/state.h"
#include "neural/vulkan/blocks.h"
#include "neural/vulkan/transfer.h"

namespace gatelight::neural::vulkan {

/// The first specialization constants of every shader that knows the network (shaders/network.glsl).
std::vector<std::uint32_t> network_constants(const Model& model);

/// Floats of the packed forms of shaders/network.glsl.
std::uint64_t forward_floats(const Model& model);
std::uint64_t backward_floats(const Model& model);

class NetworkStore {
 public:
  NetworkStore(const Device& device, Transfer& transfer, const Model& model, const TrainingOptions& options);

  void describe(ModelBlock& block) const;
  Address forward() const { return forward_.address(); }
  Address query_forward() const { return query_forward_.address(); }
  bool averages() const { return averaging_; }

  /// The network's part of the arrays, which have their sizes already, and the steps.
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
