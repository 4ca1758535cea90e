#version 460
// Measures arithmetic: each thread makes Push::argument rounds of 64 operations.

#include "blocks.glsl"

void main() {
  const uint thread = flat_thread();
  const float seed = float(thread & 255u) * 1e-3;
  vec4 a[8];
  for (uint i = 0u; i < 8u; ++i) a[i] = vec4(seed + float(i));
  const vec4 factor = vec4(0.999), addend = vec4(seed);
  for (uint round = 0u; round < argument; ++round)
    [[unroll]] for (uint i = 0u; i < 8u; ++i) a[i] = fma(a[i], factor, addend);
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < 8u; ++i) sum += a[i];
  if (sum.x + sum.y + sum.z + sum.w == -1.0) batch.answers.at[thread] = sum.x;
}
