#pragma once
// How a model learns. Sources: paper/reading numbers stand in the README beside the measured defaults.

#include <cstdint>

namespace gatelight::neural {

enum class Loss : std::uint8_t {
  l2,           ///< (y - t)^2
  relative_l2,  ///< (y - t)^2 / (luminance(y)^2 + 0.01), the denominator held constant (Mueller et al. 2021)
};
inline constexpr double kRelativeLossEpsilon = 0.01;

/// Luminance of the relative loss: 0.299, 0.587, 0.114 for three outputs, else the mean of the outputs.

/// Adam (Kingma, Ba 2015) as instant-ngp sets it: p -= lr(t) m/(1-beta1^t) / (sqrt(v/(1-beta2^t)) + epsilon),
/// lr(t) = learning_rate / sqrt(1 + (t-1)/decay_steps).
struct AdamOptions {
  float learning_rate = 1e-2f;
  float beta1 = 0.9f;
  float beta2 = 0.99f;
  float epsilon = 1e-15f;    ///< 1e-30 or more
  float l2_network = 1e-6f;  ///< added to the gradient of network weights (not of biases or features): l2 * p
  float decay_steps = 50.0f;  ///< 0: the learning rate stays
};

enum class FeatureUpdate : std::uint8_t {
  sparse,  ///< only nodes that the batch touches; others keep parameters, moments and counter
  dense,   ///< every node each step with the global counter, as the paper's baseline
};

enum class FeatureStep : std::uint8_t {
  per_node,      ///< t of a node counts the steps that touched it
  per_triangle,  ///< t of a node is the greatest count of the batch's triangles that touch it (the paper)
};

enum class FeaturePrecision : std::uint8_t {
  fp32,
  fp16_masters,  ///< forward and queries read fp16; Adam keeps fp32 masters
  fp16,          ///< fp16 only: half the memory in training too
};

/// Exponential average for queries only: a += (1 - d(t)) (p - a), d(t) = min(decay, 1 - 1/(1 + (t-1)/ramp)):
/// the first step copies. t is the global step for the network and the node's counter for features.
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
  /// With biases: the first batch sets the output bias to its mean target (start_mean.h) before it is
  /// learned.
  bool start_at_mean = true;
  /// Targets beyond this magnitude are clamped to it and counted: sums of squares of gradients stay finite.
  float max_target = 1e9f;
  /// Count how often each triangle was trained (choice of training points; implied by per_triangle).
  bool count_triangles = false;
  std::uint64_t seed = 1;
};

}  // namespace gatelight::neural
