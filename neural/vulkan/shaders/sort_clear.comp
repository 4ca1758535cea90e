#version 460
// Zeros the sums over blocks of all passes.

#include "blocks.glsl"
#include "sort.glsl"

void main() {
  batch.counts.at[kMostBlocks * kDigits + flat_thread()] = 0u;
}
