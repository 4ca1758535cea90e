#pragma once
// The network's arithmetic without kernels of our own: Eigen's matrix products on chunks of samples that stay
// in the cache. It is compiled for AVX2 and for AVX-512, each with its own namespace of Eigen.

#include <cstddef>

namespace gatelight::bench {

/// The network of nrc: 32 inputs, two hidden layers of 32 with leaky ReLU, 3 outputs, no biases. Weights are
/// [outputs][inputs] and begin with the first layer. `gradients` has the same layout.
struct EigenNetwork {
  static constexpr int kInputs = 32, kFeatureInputs = 16, kWidth = 32, kOutputs = 3;
  static constexpr int kWeights = kInputs * kWidth + kWidth * kWidth + kWidth * kOutputs;
  const float* weights = nullptr;
};

/// Runs a chunk of samples, given as rows of inputs and targets: forward, squared loss, backward to the
/// features, weight gradients. Adds to `gradients`, writes rows of kFeatureInputs to `feature_gradients`, and
/// returns the loss.
using EigenChunk = float (*)(const EigenNetwork& network, const float* inputs, const float* targets,
                             int samples, float* gradients, float* feature_gradients);

float eigen_chunk_avx2(const EigenNetwork& network, const float* inputs, const float* targets, int samples,
                       float* gradients, float* feature_gradients);
float eigen_chunk_avx512(const EigenNetwork& network, const float* inputs, const float* targets, int samples,
                         float* gradients, float* feature_gradients);

}  // namespace gatelight::bench
