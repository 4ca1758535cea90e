#version 460
// Counts the pieces and runs that begin in each block, [kind][block].

#include "blocks.glsl"
#include "runs.glsl"
#include "scan.glsl"

void main() {
  const uint block = flat_group();
  if (block >= batch.blocks) return;
  uint sum = 0u;
  for (uint k = 0u; k < kEach; ++k)
    sum += beginnings(block * kBlock + k * kThreads + gl_LocalInvocationIndex);
  uint total;
  sum_before(sum, total);
  if (gl_LocalInvocationIndex != 0u) return;
  batch.counts.at[block] = total & 0xffffu;
  batch.counts.at[batch.blocks + block] = total >> 16;
}
