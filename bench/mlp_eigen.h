#pragma once
// The honest cheap way to do the network's arithmetic: Eigen's matrix products on chunks of samples that stay
// in the cache. Compiled for AVX2 and for AVX-512, each with an Eigen of its own name.

#include <cstddef>

namespace gatelight::bench {

/// Two hidden layers of 32, leaky ReLU, 32 inputs and 3 outputs: the network of nrc. Weights are
/// [outputs][inputs], `gradients` as long as they are; both begin with the first layer and have no biases.
struct EigenNetwork {
  static constexpr int kInputs = 32, kFeatureInputs = 16, kWidth = 32, kOutputs = 3;
  static constexpr int kWeights = kInputs * kWidth + kWidth * kWidth + kWidth * kOutputs;
  const float* weights = nullptr;
};

/// Forward, squared loss, backward to the features, weight gradients of a chunk: rows of inputs and targets.
/// Adds to `gradients`, writes rows of kFeatureInputs, returns the loss.
using EigenChunk = float (*)(const EigenNetwork& network, const float* inputs, const float* targets,
                             int samples, float* gradients, float* feature_gradients);

float eigen_chunk_avx2(const EigenNetwork& network, const float* inputs, const float* targets, int samples,
                       float* gradients, float* feature_gradients);
float eigen_chunk_avx512(const EigenNetwork& network, const float* inputs, const float* targets, int samples,
                         float* gradients, float* feature_gradients);

}  // namespace gatelight::bench
