#pragma once
// The feature vectors and their optimiser state in the memory layout of the kernels.

#include <cstdint>

#include "base/platform/huge_buffer.h"
#include "neural/cpu/kernels.h"
#include "neural/model/state.h"

namespace gatelight::neural::cpu {

/// Updates are bound by memory, so the data of a node lies in as few cache lines as possible: a short feature
/// vector beside its average, the step count behind the moments. Long feature vectors and averages have
/// separate arrays.
class FeatureStore {
 public:
  /// Starts with initial_state. Moments and counters are not touched, so they take no memory before training.
  FeatureStore(const Model& model, const TrainingOptions& options);

  void set_training_view(KernelEncoder& encoder) const;
  void set_query_view(KernelEncoder& encoder, bool averaged) const;
  void set_update_view(KernelFeatureUpdate& update) const;

  /// Resizes the arrays and writes the features' part.
  void export_to(ModelState& state) const;
  void import_from(const ModelState& state);

  /// Bytes that a forward pass reads from.
  std::uint64_t parameter_bytes() const;
  /// Bytes of moments, masters, averages and counters.
  std::uint64_t optimizer_bytes() const;

 private:
  /// `at` is node * feature_stride_ + feature.
  void set(std::uint64_t at, float feature, float average);
  std::uint64_t floats_of(std::uint64_t per_node) const;

  std::uint64_t count_;      // number of feature floats
  std::uint64_t all_count_;  // number of the model's parameters
  std::uint32_t features_;
  FeaturePrecision precision_;
  HugeBuffer<float> floats_;          // parameters or masters
  HugeBuffer<std::uint16_t> halves_;  // parameters in fp16
  HugeBuffer<float> separate_averages_;
  HugeBuffer<std::uint16_t> separate_average_halves_;
  HugeBuffer<float> moments_;
  HugeBuffer<std::uint32_t> separate_steps_;
  // Pointers into the buffers above.
  float* averages_ = nullptr;
  std::uint16_t* average_halves_ = nullptr;
  std::uint32_t* steps_ = nullptr;
  std::uint32_t feature_stride_ = 0, moment_stride_ = 0, step_stride_ = 1;
  std::uint32_t nodes_;
  bool averaging_, sparse_;
};

}  // namespace gatelight::neural::cpu
