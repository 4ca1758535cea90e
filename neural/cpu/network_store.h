#pragma once
// The network's parameters with Adam's moments and the running average.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "neural/cpu/packed_network.h"
#include "neural/model/model.h"
#include "neural/model/state.h"
#include "neural/model/training_options.h"

namespace gatelight::neural::cpu {

class NetworkStore {
 public:
  /// The network's part of a ModelState, each in the packed layout.
  struct Arrays {
    HugeBuffer<float> parameters, averages, first_moments, second_moments;
  };

  /// Both must outlive the object.
  NetworkStore(const Model& model, const TrainingOptions& options);

  const KernelNetwork& kernel() const { return raw_.kernel(); }
  /// The network of a query; `rounded`: also its forms for bf16. Thread-safe between updates.
  const KernelNetwork& query_kernel(bool averaged, bool rounded) const;

  void set_output_biases(std::span<const double> values);
  /// The number of floats of the packed layout.
  std::uint64_t size() const { return layout_.size(); }
  /// Adam's step for the parameters begin <= index < end, whose gradients are the sums of `count` arrays of
  /// the packed layout, in their order, times `scale`. Ranges may be updated at the same time. Returns the
  /// number of parameters that were skipped because their gradient is not finite.
  std::uint64_t update(std::uint64_t begin, std::uint64_t end, const float* gradients, std::uint32_t count,
                       float scale, const KernelAdamStep& adam);
  /// Call it when all ranges are updated.
  void updated();

  void export_to(ModelState& state) const;
  /// Copies the network's part; then set() cannot fail.
  Arrays arrays_of(const ModelState& state) const;
  void set(const Arrays& arrays);

 private:
  const ParameterLayout& parameters_;
  const TrainingOptions& options_;
  PackedLayout layout_;
  Arrays arrays_;
  // The forms that only queries read are made by the first one.
  mutable PackedNetwork raw_, averaged_;
  mutable std::mutex mutex_;
  mutable std::atomic<bool> averaged_ready_ = false;
  mutable std::atomic<bool> rounded_ready_[2] = {false, false};  ///< of raw_, of averaged_
};

}  // namespace gatelight::neural::cpu
