#pragma once
// Everything that training changes. Backends export and import it in one common layout.

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "neural/model/model.h"
#include "neural/model/training_options.h"

namespace gatelight::neural {

/// Arrays have the layout of ParameterLayout. Features in fp16 without masters are converted to float.
struct ModelState {
  std::vector<float> parameters;
  std::vector<float> averages;       ///< used by queries; equal to the parameters if averaging is off
  std::vector<float> first_moments;  ///< Adam's m
  std::vector<float> second_moments;
  std::vector<std::uint32_t> node_steps;      ///< Adam's t of each node; empty with dense updates
  std::vector<std::uint32_t> triangle_steps;  ///< for each triangle with storage; empty unless counted
  std::uint64_t steps = 0;

  friend bool operator==(const ModelState&, const ModelState&) = default;
};

inline constexpr float kFeatureRange = 1e-4f;

/// The state before training. Features are uniform in +-kFeatureRange, weights Xavier uniform (+-sqrt(6 /
/// (inputs + outputs))), biases zero. They depend only on `options.seed` and the parameter's index. With fp16
/// features they are rounded to fp16.
ModelState initial_state(const Model& model, const TrainingOptions& options);

/// The parts of initial_state, for backends with their own arrays: the feature float with index i, and the
/// network's parameters in order. Averages equal the parameters; everything else is zero.
inline float initial_feature(const TrainingOptions& options, std::uint64_t i) {
  return kFeatureRange * (2.0f * uniform_float(options.seed, i) - 1.0f);
}
std::vector<float> initial_network(const Model& model, const TrainingOptions& options);

}  // namespace gatelight::neural
