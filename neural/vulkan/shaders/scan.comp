#version 460
// Exclusive prefix sums of arrays in Batch::counts, one workgroup per array of Push::argument words. Its
// total goes to word Push::other + array of the statistics.

#include "blocks.glsl"
#include "scan.glsl"

const uint kEach = 8;
const uint kNowhere = 0xffffffffu;

void main() {
  const uint length = argument, base = gl_WorkGroupID.x * length;
  uint carried = 0u;
  for (uint begin = 0u; begin < length; begin += kThreads * kEach) {
    const uint first = begin + gl_LocalInvocationIndex * kEach;
    uint values[kEach];
    uint sum = 0u;
    for (uint k = 0u; k < kEach; ++k) {
      values[k] = first + k < length ? batch.counts.at[base + first + k] : 0u;
      sum += values[k];
    }
    uint total;
    uint before = carried + sum_before(sum, total);
    for (uint k = 0u; k < kEach; ++k) {
      if (first + k < length) batch.counts.at[base + first + k] = before;
      before += values[k];
    }
    carried += total;
  }
  if (gl_LocalInvocationIndex == 0u && other != kNowhere)
    batch.statistics.at[other + gl_WorkGroupID.x] = carried;
}
