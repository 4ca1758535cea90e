#pragma once
// Everything that training changes, in one layout for all backends: what export gives and import takes.

#include <cstdint>
#include <vector>

#include "neural/base/random.h"
#include "neural/model/model.h"
#include "neural/model/training_options.h"

namespace gatelight::neural {

/// Arrays are in the layout of ParameterLayout. fp16-only features are held here as the floats they stand
/// for.
struct ModelState {
  std::vector<float> parameters;
  std::vector<float> averages;       ///< what queries use; equals parameters where averaging is off
  std::vector<float> first_moments;  ///< Adam's m
  std::vector<float> second_moments;
  std::vector<std::uint32_t> node_steps;      ///< per node; empty with dense updates
  std::vector<std::uint32_t> triangle_steps;  ///< per triangle with storage; empty unless counted
  std::uint64_t steps = 0;

  friend bool operator==(const ModelState&, const ModelState&) = default;
};

inline constexpr float kFeatureRange = 1e-4f;

/// Features uniform in +-kFeatureRange, weights Xavier uniform (+-sqrt(6 / (inputs + outputs))), biases zero;
/// all from `options.seed` and the parameter's index alone. With fp16 features the values are ones that fp16
/// holds.
ModelState initial_state(const Model& model, const TrainingOptions& options);

/// Its parts, for backends that make their arrays themselves: the feature float with index i, and the
/// network's parameters, in their order. Averages equal parameters, all else is zero.
inline float initial_feature(const TrainingOptions& options, std::uint64_t i) {
  return kFeatureRange * (2.0f * uniform_float(options.seed, i) - 1.0f);
}
std::vector<float> initial_network(const Model& model, const TrainingOptions& options);

}  // namespace gatelight::neural
