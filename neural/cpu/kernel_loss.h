#pragma once
// Loss and its gradient for the rows of a tile. Part of kernels.cpp.

#include "neural/cpu/kernels.h"
#include "neural/cpu/simd.h"

namespace {

using namespace gatelight::neural::cpu;

// Luminance of the relative loss: NTSC weights for three outputs (as tiny networks for radiance use them),
// else the mean.
GATELIGHT_INLINE float output_luminance(const float* y, uint32_t outputs) {
  if (outputs == 3) return 0.299f * y[0] + 0.587f * y[1] + 0.114f * y[2];
  float total = 0.0f;
  for (uint32_t c = 0; c < outputs; ++c) total += y[c];
  return total / static_cast<float>(outputs);
}

// Per row the sum over outputs of (y-t)^2 / denominator and its derivatives 2 (y-t) / denominator; the mean
// over records and outputs is taken where gradients are used. Rows that are not valid, and those up to
// `rows`, get zeros. Returns the sum of the losses.
template <uint32_t kOutputs>
GATELIGHT_INLINE double loss_rows(uint32_t outputs, bool relative, float max_target, const float* targets,
                                  const float* valid, uint32_t count, uint32_t rows, const float* y,
                                  float* gradients, uint32_t& clipped) {
  if (kOutputs != 0) outputs = kOutputs;
  double total = 0.0;
  for (uint32_t r = 0; r < rows; ++r, y += kOutputStride, gradients += kOutputStride) {
    if (r >= count || valid[r] == 0.0f) {
      for (uint32_t c = 0; c < outputs; ++c) gradients[c] = 0.0f;
      continue;
    }
    float inverse = 1.0f;
    if (relative) {
      const float luminance = output_luminance(y, outputs);
      inverse = 1.0f / (luminance * luminance + 0.01f);
    }
    const float* target = targets + uint64_t{r} * outputs;
    float sum = 0.0f;
    bool clamped = false;
    for (uint32_t c = 0; c < outputs; ++c) {
      float t = target[c];
      if (__builtin_fabsf(t) > max_target) {
        t = t < 0.0f ? -max_target : max_target;
        clamped = true;
      }
      const float difference = y[c] - t;
      const float scaled = difference * inverse;
      sum += difference * scaled;
      gradients[c] = 2.0f * scaled;
    }
    clipped += clamped ? 1 : 0;
    total += sum;
  }
  return total;
}

GATELIGHT_INLINE double loss(uint32_t outputs, bool relative, float max_target, const float* targets,
                             const float* valid, uint32_t count, uint32_t rows, const float* y,
                             float* gradients, uint32_t& clipped) {
  if (outputs == 3)
    return loss_rows<3>(outputs, relative, max_target, targets, valid, count, rows, y, gradients, clipped);
  if (outputs == 1)
    return loss_rows<1>(outputs, relative, max_target, targets, valid, count, rows, y, gradients, clipped);
  return loss_rows<0>(outputs, relative, max_target, targets, valid, count, rows, y, gradients, clipped);
}

}  // namespace
