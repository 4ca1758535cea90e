#pragma once
// The network's parameters with Adam's moments and the running average, and their packed forms.

#include <cstdint>
#include <span>
#include <vector>

#include "neural/cpu/packed_network.h"
#include "neural/model/model.h"
#include "neural/model/state.h"
#include "neural/model/training_options.h"

namespace gatelight::neural::cpu {

class NetworkStore {
 public:
  /// The network's part of a ModelState.
  struct Arrays {
    std::vector<float> parameters, averages, first_moments, second_moments;
  };

  /// Both must outlive the object.
  NetworkStore(const Model& model, const TrainingOptions& options);

  const PackedNetwork& packed() const { return raw_; }
  /// The network of a query. Not thread-safe where the averages are packed for the first time after a step.
  const KernelNetwork& query_kernel(bool averaged) const;

  void set_output_biases(std::span<const double> values);
  /// Adam's step number `step` with the sum of the packed gradients, times `scale`. Returns the number of
  /// parameters that were skipped because their gradient is not finite.
  std::uint64_t update(const float* packed_gradients, float scale, std::uint64_t step);

  void export_to(ModelState& state) const;
  /// Copies the network's part; then set() cannot fail.
  Arrays arrays_of(const ModelState& state) const;
  void set(Arrays arrays);

 private:
  const ParameterLayout& layout_;
  const TrainingOptions& options_;
  Arrays arrays_;
  std::vector<float> gradients_;
  PackedNetwork raw_;
  mutable PackedNetwork averaged_;
  mutable bool averaged_packed_ = false;
};

}  // namespace gatelight::neural::cpu
