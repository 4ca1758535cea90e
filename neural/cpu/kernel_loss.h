#pragma once
// Loss and its gradient for the rows of a tile. Part of kernel_table.cpp.

#include "neural/cpu/kernel_short_vectors.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural::cpu;

// Luminance of the relative loss: NTSC weights for three outputs, else the mean.
GATELIGHT_INLINE float output_luminance(const float* y, uint32_t outputs) {
  if (outputs == 3) return 0.299f * y[0] + 0.587f * y[1] + 0.114f * y[2];
  float total = 0.0f;
  for (uint32_t c = 0; c < outputs; ++c) total += y[c];
  return total / static_cast<float>(outputs);
}

// Replaces the outputs y by derivatives. A row's loss is the sum over outputs of (y-t)^2 / denominator, with
// derivatives 2 (y-t) / denominator; the update divides by records and outputs. Invalid rows and rows from
// `count` to `rows` become zeros. Returns the sum of the losses.
template <uint32_t kOutputs>
GATELIGHT_INLINE double loss_rows(uint32_t outputs, bool relative, float max_target, const float* targets,
                                  const float* valid, uint32_t count, uint32_t rows, float* y,
                                  uint32_t& clipped) {
  if (kOutputs != 0) outputs = kOutputs;
  double total = 0.0;
  for (uint32_t r = 0; r < rows; ++r, y += kOutputStride) {
    if (r >= count || valid[r] == 0.0f) {
      for (uint32_t c = 0; c < outputs; ++c) y[c] = 0.0f;
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
      y[c] = 2.0f * scaled;
    }
    clipped += clamped ? 1 : 0;
    total += sum;
  }
  return total;
}

typedef int32_t Index4 __attribute__((vector_size(16)));

GATELIGHT_INLINE float sum4(Short4 v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}

// The same for up to four outputs if all rows are valid and no target exceeds max_target. A row is a vector
// whose unused lanes are zeros. It reads four floats per row of targets, so it cannot process the tile's last
// rows.
template <uint32_t kOutputs>
GATELIGHT_INLINE double loss_plain_rows(bool relative, const float* targets, uint32_t count, float* y) {
  const Index4 used = {-1, kOutputs > 1 ? -1 : 0, kOutputs > 2 ? -1 : 0, kOutputs > 3 ? -1 : 0};
  const Short4 luminance = kOutputs == 3 ? Short4{0.299f, 0.587f, 0.114f, 0.0f}
                                         : Short4{1.0f, 1.0f, 1.0f, 1.0f} / static_cast<float>(kOutputs);
  Short4 total = {};
#pragma GCC unroll 2
  for (uint32_t r = 0; r < count; ++r, y += kOutputStride, targets += kOutputs) {
    Short4 value, target;
    __builtin_memcpy(&value, y, sizeof value);
    __builtin_memcpy(&target, targets, sizeof target);
    value = (Short4)((Index4)value & used);
    const Short4 difference = value - (Short4)((Index4)target & used);
    Short4 scaled = difference;
    if (relative) {
      Short4 l = value * luminance;
      l += __builtin_shufflevector(l, l, 2, 3, 0, 1);
      l += __builtin_shufflevector(l, l, 1, 0, 3, 2);
      scaled = difference / (l * l + 0.01f);
    }
    total += difference * scaled;
    scaled += scaled;
    __builtin_memcpy(y, &scaled, sizeof scaled);
  }
  return sum4(total);
}

// Whether all rows of a full tile are valid and no target exceeds max_target.
GATELIGHT_INLINE bool plain(const float* targets, uint32_t outputs, float max_target, const float* valid) {
  static_assert(kTile % kLanes == 0);
  Float least = 1.0f;
  for (uint32_t s = 0; s < kTile; s += kLanes) least = min(least, load(valid + s));
  Float greatest = 0.0f;
  for (uint32_t i = 0; i < kTile * outputs; i += kLanes)
    greatest = max(greatest, absolute(load(targets + i)));
  return all(least > 0.0f) && !any(greatest > max_target);
}

template <uint32_t kOutputs>
GATELIGHT_INLINE double loss_of(uint32_t outputs, bool relative, float max_target, const float* targets,
                                const float* valid, uint32_t count, uint32_t rows, float* y,
                                uint32_t& clipped) {
  if constexpr (kOutputs == 1 || kOutputs == 3) {
    if (count == kTile && plain(targets, kOutputs, max_target, valid)) {
      constexpr uint32_t kFrom = kTile - (kOutputs == 1 ? 3 : 1);
      const double total = loss_plain_rows<kOutputs>(relative, targets, kFrom, y);
      return total + loss_rows<kOutputs>(outputs, relative, max_target, targets + kFrom * kOutputs,
                                         valid + kFrom, kTile - kFrom, kTile - kFrom,
                                         y + kFrom * kOutputStride, clipped);
    }
  }
  return loss_rows<kOutputs>(outputs, relative, max_target, targets, valid, count, rows, y, clipped);
}

GATELIGHT_NOINLINE double loss(uint32_t outputs, bool relative, float max_target, const float* targets,
                               const float* valid, uint32_t count, uint32_t rows, float* y,
                               uint32_t& clipped) {
  if (outputs == 3) return loss_of<3>(outputs, relative, max_target, targets, valid, count, rows, y, clipped);
  if (outputs == 1) return loss_of<1>(outputs, relative, max_target, targets, valid, count, rows, y, clipped);
  return loss_of<0>(outputs, relative, max_target, targets, valid, count, rows, y, clipped);
}

}  // namespace
