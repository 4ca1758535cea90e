#version 460
// Writes the start of each piece, and the node and first piece of each run. Each list ends with the start of
// the next, non-existing entry.

#include "blocks.glsl"
#include "runs.glsl"
#include "scan.glsl"

void main() {
  const uint block = flat_group();
  if (block >= batch.blocks) return;
  const uint first = block * kBlock + gl_LocalInvocationIndex * kEach;
  uint sum = 0u;
  for (uint k = 0u; k < kEach; ++k) sum += beginnings(first + k);
  uint total;
  const uint before = sum_before(sum, total);
  uint piece = batch.counts.at[block] + (before & 0xffffu);
  uint run = batch.counts.at[batch.blocks + block] + (before >> 16);
  for (uint k = 0u; k < kEach; ++k) {
    const uint i = first + k;
    if (!is_reference(i)) return;
    const uint begins = beginnings(i);
    if (begins >> 16 != 0u) {
      batch.nodes.at[run] = key_at(i);
      batch.node_pieces.at[run] = piece;
      ++run;
    }
    if (begins != 0u) batch.piece_starts.at[piece++] = i;
    if (!is_reference(i + 1u)) {
      batch.piece_starts.at[piece] = i + 1u;
      batch.node_pieces.at[run] = piece;
    }
  }
}
