#version 460
// Sums the losses of all tiles in one order and counts the step, before its updates. One workgroup.

#include "blocks.glsl"

shared float sums[kThreads];

void main() {
  float sum = 0.0;
  for (uint tile = gl_LocalInvocationIndex; tile < batch.tiles; tile += kThreads) sum += batch.losses.at[tile];
  sums[gl_LocalInvocationIndex] = sum;
  barrier();
  for (uint half_size = kThreads / 2u; half_size > 0u; half_size /= 2u) {
    if (gl_LocalInvocationIndex < half_size)
      sums[gl_LocalInvocationIndex] += sums[gl_LocalInvocationIndex + half_size];
    barrier();
  }
  if (gl_LocalInvocationIndex != 0u) return;
  batch.statistics.at[kLoss] = floatBitsToUint(sums[0]);
  if (batch.statistics.at[kAccepted] == 0u) return;
  const uint low = model.progress.at[0] + 1u;
  model.progress.at[0] = low;
  if (low == 0u) model.progress.at[1] += 1u;
}
