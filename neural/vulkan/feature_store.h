#pragma once
// The feature vectors, their optimiser state and counters on the device.

#include "neural/model/state.h"
#include "neural/vulkan/table.h"

namespace gatelight::neural::vulkan {

/// Bytes of a FeatureStore.
std::uint64_t feature_bytes(const Model& model, const TrainingOptions& options);

class FeatureStore {
 public:
  FeatureStore(const Device& device, Transfer& transfer, const Model& model, const TrainingOptions& options,
               std::uint64_t longest_part);

  void describe(ModelBlock& block) const;
  /// The table that a forward pass reads: averages or parameters.
  TableBlock readable(bool averaged) const;
  bool halves() const { return !halves_.empty(); }
  bool floats() const { return !features_.empty(); }
  bool averages() const { return !averages_.empty() || !average_halves_.empty(); }
  bool counts_triangles() const { return !triangle_steps_.empty(); }

  /// Writes the features' part of the arrays, which must have their sizes.
  void export_to(Transfer& transfer, ModelState& state) const;
  void import_from(Transfer& transfer, const ModelState& state);

  std::uint64_t parameter_bytes() const;
  std::uint64_t optimizer_bytes() const;

 private:
  std::uint64_t nodes_, features_per_node_, triangles_;
  Table features_, halves_, averages_, average_halves_, moments_, node_steps_, triangle_steps_,
      triangle_stamps_;
};

}  // namespace gatelight::neural::vulkan
