#version 460
// Measures sequential reads: all threads together read Push::argument vectors of Batch::forward.

#include "blocks.glsl"

void main() {
  const uint threads = gl_NumWorkGroups.x * gl_NumWorkGroups.y * kThreads;
  vec4 sum = vec4(0.0);
  for (uint i = flat_thread(); i < argument; i += threads) sum += batch.forward.at[i];
  if (sum.x + sum.y + sum.z + sum.w == -1.0) batch.answers.at[0] = sum.x;
}
