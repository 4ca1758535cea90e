#version 460
// Moves each reference to its place: the start of its digit in this block, plus the number of such references
// before it in the block.

#include "blocks.glsl"
#include "scan.glsl"
#include "sort.glsl"

const uint kPairs = kDigits / 2u;
const uint kEntries = kPairs * kThreads;

// Counts by [digit][thread]: digits below eight are in the lower halves of words, the others in the upper
// halves.
shared uint counts[kEntries];
shared uint starts[kPairs];

uint entry_of(uint digit) {
  return digit % kPairs * kThreads + gl_LocalInvocationIndex;
}

uint half_shift(uint digit) {
  return digit / kPairs * 16u;
}

void count_own(uint first, Words keys) {
  for (uint pair = 0u; pair < kPairs; ++pair) counts[pair * kThreads + gl_LocalInvocationIndex] = 0u;
  for (uint k = 0u; k < kEach && first + k < batch.references; ++k) {
    const uint digit = digit_of(keys.at[first + k]);
    counts[entry_of(digit)] += 1u << half_shift(digit);
  }
}

// Replaces counts by sums of all earlier entries; upper halves follow all lower halves.
void scan_counts() {
  const uint own = gl_LocalInvocationIndex * kPairs;
  uint sum = 0u;
  for (uint k = 0u; k < kPairs; ++k) {
    const uint value = counts[own + k];
    counts[own + k] = sum;
    sum += value;
  }
  uint total;
  const uint before = sum_before(sum, total) + (total << 16);
  for (uint k = 0u; k < kPairs; ++k) counts[own + k] += before;
}

void main() {
  const uint block = flat_group();
  if (block >= batch.blocks) return;
  Words keys = batch.keys[from_array()], values = batch.values[from_array()];
  Words new_keys = batch.keys[1u - from_array()], new_values = batch.values[1u - from_array()];
  const uint first = block * kBlock + gl_LocalInvocationIndex * kEach;
  count_own(first, keys);
  barrier();
  scan_counts();
  barrier();
  if (gl_LocalInvocationIndex < kPairs)
    starts[gl_LocalInvocationIndex] = counts[gl_LocalInvocationIndex * kThreads];
  barrier();
  for (uint k = 0u; k < kEach && first + k < batch.references; ++k) {
    const uint key = keys.at[first + k];
    const uint digit = digit_of(key);
    const uint rank = counts[entry_of(digit)] >> half_shift(digit) & 0xffffu;
    const uint start = starts[digit % kPairs] >> half_shift(digit) & 0xffffu;
    counts[entry_of(digit)] += 1u << half_shift(digit);
    const uint place = batch.counts.at[digit * batch.blocks + block] + rank - start;
    new_keys.at[place] = key;
    new_values.at[place] = argument == 0u ? first + k : values.at[first + k];
  }
}
