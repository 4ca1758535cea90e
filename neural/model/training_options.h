#pragma once
// The options of training. The measurements behind the defaults are in neural/learning/README.md.

#include <cstdint>

namespace gatelight::neural {

/// The error of an output y with the target t. The luminance of y has the weights 0.299, 0.587, 0.114 for
/// three outputs; else it is the mean of the outputs.
enum class Loss : std::uint8_t {
  l2,           ///< (y - t)^2
  relative_l2,  ///< (y - t)^2 / (luminance(y)^2 + 0.01), denominator held constant (Mueller et al. 2021)
};
inline constexpr double kRelativeLossEpsilon = 0.01;

/// Adam (Kingma, Ba 2015) as instant-ngp sets it: p -= lr(t) m/(1-beta1^t) / (sqrt(v/(1-beta2^t)) + epsilon),
/// lr(t) = learning_rate / sqrt(1 + (t-1)/decay_steps).
struct AdamOptions {
  float learning_rate = 1e-2f;
  float beta1 = 0.9f;
  float beta2 = 0.99f;
  float epsilon = 1e-15f;     ///< at least 1e-30
  float l2_network = 1e-6f;   ///< adds l2 * p to the gradient of network weights only
  float decay_steps = 50.0f;  ///< 0 means a constant learning rate
};

enum class FeatureUpdate : std::uint8_t {
  sparse,  ///< only nodes that the batch touches; others keep parameters, moments and counter
  dense,   ///< every node in each step with the global step count, as in the paper's baseline
};

enum class FeatureStep : std::uint8_t {
  per_node,      ///< t of a node counts the steps that touched it
  per_triangle,  ///< t of a node is the largest count of the batch's triangles that touch it (the paper)
};

enum class FeaturePrecision : std::uint8_t {
  fp32,
  fp16_masters,  ///< forward and queries read fp16; Adam keeps fp32 masters
  fp16,          ///< fp16 only, which also halves the memory in training
};

/// Exponential average, which only queries use: a += (1 - d(t)) (p - a), d(t) = min(decay, 1 - 1/(1 +
/// (t-1)/ramp)). The first step copies. t is the global step for the network and the node's counter for
/// features.
struct AverageOptions {
  bool network = true;
  bool features = true;
  float decay = 0.99f;
  float ramp = 10.0f;
};

struct TrainingOptions {
  Loss loss = Loss::relative_l2;
  AdamOptions adam;
  FeatureUpdate update = FeatureUpdate::sparse;
  FeatureStep feature_step = FeatureStep::per_node;
  FeaturePrecision precision = FeaturePrecision::fp32;
  AverageOptions average;
  /// Before its step, the first batch sets the output bias to its mean target (start_mean.h). Needs biases.
  bool start_at_mean = true;
  /// Larger magnitudes of targets are clamped to this value and counted, so that squared gradients stay
  /// finite.
  float max_target = 1e9f;
  /// Count how often each triangle is trained, for the choice of training points. Implied by per_triangle.
  bool count_triangles = false;
  std::uint64_t seed = 1;

  bool counts_triangles() const { return count_triangles || feature_step == FeatureStep::per_triangle; }
};

}  // namespace gatelight::neural
