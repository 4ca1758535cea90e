#version 460
// Counts the references of each block by digit, [digit][block].

#include "blocks.glsl"
#include "sort.glsl"

shared uint digit_counts[kDigits];

void main() {
  const uint block = flat_group();
  if (block >= batch.blocks) return;
  if (gl_LocalInvocationIndex < kDigits) digit_counts[gl_LocalInvocationIndex] = 0u;
  barrier();
  Words keys = batch.keys[from_array()];
  for (uint k = 0u; k < kEach; ++k) {
    const uint i = block * kBlock + k * kThreads + gl_LocalInvocationIndex;
    if (i < batch.references) atomicAdd(digit_counts[digit_of(keys.at[i])], 1u);
  }
  barrier();
  if (gl_LocalInvocationIndex < kDigits)
    batch.counts.at[gl_LocalInvocationIndex * batch.blocks + block] = digit_counts[gl_LocalInvocationIndex];
}
