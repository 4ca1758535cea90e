#pragma once
// The constant data of a model on the device.

#include "neural/model/training_options.h"
#include "neural/vulkan/table.h"

namespace gatelight::neural::vulkan {

class ModelTables {
 public:
  /// Throws BadConfiguration for more surfaces than a buffer can hold.
  ModelTables(const Device& device, Transfer& transfer, const Model& model, const TrainingOptions& options,
              std::uint64_t longest_part);

  /// Sets all members that training does not change.
  void describe(ModelBlock& block) const;

 private:
  const Model& model_;
  const TrainingOptions& options_;
  Table topology_;
  Buffer surfaces_, levels_, adam_;
};

}  // namespace gatelight::neural::vulkan
