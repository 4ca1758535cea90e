#version 460
// Counts the references of each block by digit, and adds these counts to the sums over blocks.

#include "blocks.glsl"
#include "sort.glsl"

void main() {
  const uint block = gl_WorkGroupID.x;
  clear_counts();
  count_digits(block_begin(block), block_begin(block + 1u), 0u);
  barrier();
  for (uint digit = gl_LocalInvocationIndex; digit < kDigits; digit += kThreads) {
    const uint count = digit_counts[digit];
    batch.counts.at[block * kDigits + digit] = count;
    if (count != 0u) atomicAdd(batch.counts.at[sum_row(argument, block) * kDigits + digit], count);
  }
}
