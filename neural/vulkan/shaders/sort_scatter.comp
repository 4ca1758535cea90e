#version 460
// Moves each reference to its place: behind all references with lower digits and behind earlier ones with the
// same digit. A round places one reference per thread.

#include "blocks.glsl"
#include "scan.glsl"
#include "sort.glsl"

layout(constant_id = 0) const bool kCounted = false;  // by sort_count; else a workgroup counts all references

const uint kMaskWords = kThreads / 32u;
const uint kMasks = kDigits * kMaskWords;

// Bit t of a digit's mask is set if thread t has a reference with this digit. Rounds alternate between two sets.
shared uint masks[2u * kMasks];
shared uint places[kDigits];  // of the block's next reference with this digit

// The references with the digits 2 t and 2 t + 1 of thread t, in earlier blocks and in all.
void read_counts(uint block, out uvec2 before, out uvec2 all) {
  Pairs rows = Pairs(batch.counts);
  const uint t = gl_LocalInvocationIndex, row_pairs = kDigits / 2u;
  const uint own = block / kBlocksASum;
  before = all = uvec2(0u);
  for (uint sum = 0u; sum * kBlocksASum < gl_NumWorkGroups.x; ++sum) {
    const uvec2 counts = rows.at[sum_row(argument, sum * kBlocksASum) * row_pairs + t];
    all += counts;
    if (sum < own) before += counts;
  }
  for (uint b = own * kBlocksASum; b < block; ++b) before += rows.at[b * row_pairs + t];
}

void count_all(uint begin, out uvec2 before, out uvec2 all) {
  clear_counts();
  count_digits(0u, begin, 0u);
  count_digits(begin, batch.references, kDigits);
  barrier();
  const uint digit = 2u * gl_LocalInvocationIndex;
  before = uvec2(digit_counts[digit], digit_counts[digit + 1u]);
  all = before + uvec2(digit_counts[kDigits + digit], digit_counts[kDigits + digit + 1u]);
}

void find_places(uint block, uint begin) {
  uvec2 before, all;
  if (kCounted)
    read_counts(block, before, all);
  else
    count_all(begin, before, all);
  uint total;
  const uint start = sum_before(all.x + all.y, total);
  places[2u * gl_LocalInvocationIndex] = start + before.x;
  places[2u * gl_LocalInvocationIndex + 1u] = start + all.x + before.y;
}

void play_round(uvec2 reference, bool exists, uint first_mask) {
  const uint t = gl_LocalInvocationIndex, bit = 1u << t % 32u;
  const uint digit = digit_of(reference.x), mask = first_mask + digit * kMaskWords;
  if (exists) atomicOr(masks[mask + t / 32u], bit);
  barrier();
  uint before = 0u, count = 0u;
  if (exists) {
    [[unroll]] for (uint w = 0u; w < kMaskWords; ++w) {
      const uint word = masks[mask + w];
      before += bitCount(w < t / 32u ? word : w == t / 32u ? word & (bit - 1u) : 0u);
      count += bitCount(word);
    }
    batch.sorted[argument % 2u].at[places[digit] + before] = reference;
  }
  barrier();
  if (!exists || before != 0u) return;
  places[digit] += count;
  [[unroll]] for (uint w = 0u; w < kMaskWords; ++w) masks[mask + w] = 0u;
}

void main() {
  const uint block = gl_WorkGroupID.x, t = gl_LocalInvocationIndex;
  const uint begin = block_begin(block), end = block_begin(block + 1u);
  for (uint word = t; word < 2u * kMasks; word += kThreads) masks[word] = 0u;
  find_places(block, begin);
  barrier();
  for (uint first = begin; first < end; first += kAtOnce * kThreads) {
    uvec2 references[kAtOnce];
    [[unroll]] for (uint k = 0u; k < kAtOnce; ++k)
      references[k] = reference_at(min(first + k * kThreads + t, end - 1u));
    [[unroll]] for (uint k = 0u; k < kAtOnce; ++k)
      if (first + k * kThreads < end)
        play_round(references[k], first + k * kThreads + t < end, k % 2u * kMasks);
  }
}
