// A stable radix sort of references by node, one digit of at most eight bits per pass. Push::argument is the
// number of the pass, Push::other the bits of a digit. Each workgroup has a block of consecutive references.

const uint kAtOnce = 8;  // references that a thread loads before it uses one

shared uint digit_counts[2u * kDigits];

// The row of Batch::counts with the sum over kBlocksASum blocks.
uint sum_row(uint pass, uint block) {
  return kMostBlocks + pass * kSumsAPass + block / kBlocksASum;
}

uint block_begin(uint block) {
  const uint rounds = (batch.references + gl_NumWorkGroups.x * kThreads - 1u) / (gl_NumWorkGroups.x * kThreads);
  return min(block * rounds * kThreads, batch.references);
}

uint digit_of(uint node) {
  return node >> argument * other & ((1u << other) - 1u);
}

// Node and number of a reference in the order before this pass.
uvec2 reference_at(uint i) {
  return argument == 0u ? uvec2(batch.keys.at[i], i) : batch.sorted[(argument + 1u) % 2u].at[i];
}

void clear_counts() {
  for (uint bin = gl_LocalInvocationIndex; bin < 2u * kDigits; bin += kThreads) digit_counts[bin] = 0u;
  barrier();
}

// Counts the references begin .. end - 1 by digit.
void count_digits(uint begin, uint end, uint first_bin) {
  for (uint first = begin + gl_LocalInvocationIndex; first < end; first += kAtOnce * kThreads) {
    uint digits[kAtOnce];
    [[unroll]] for (uint k = 0u; k < kAtOnce; ++k)
      digits[k] = digit_of(reference_at(min(first + k * kThreads, end - 1u)).x);
    [[unroll]] for (uint k = 0u; k < kAtOnce; ++k)
      if (first + k * kThreads < end) atomicAdd(digit_counts[first_bin + digits[k]], 1u);
  }
}
