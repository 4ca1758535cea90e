#version 460
// Before the first step, sets the output biases to the mean target of the accepted records
// (neural/learning/start_mean.h) and packs them, so that the network starts with the right brightness. One workgroup.
// Push::argument is the index of the first output bias.

#define GATELIGHT_SHAPE_OF_MODEL
#include "blocks.glsl"
#include "pack.glsl"
#include "scan.glsl"

shared float sums[kThreads];

bool is_accepted(uint record) {
  return batch.status.at[record] == kStatusAccepted;
}

// The number of accepted non-zero targets whose magnitude is at most the float with these bits.
uint count_up_to(uint o, uint bits) {
  uint count = 0u;
  for (uint record = gl_LocalInvocationIndex; record < batch.size; record += kThreads) {
    if (!is_accepted(record)) continue;
    const uint magnitude = floatBitsToUint(batch.targets.at[record * model.outputs + o]) & 0x7fffffffu;
    if (magnitude != 0u && magnitude <= bits) ++count;
  }
  uint all;
  sum_before(count, all);
  return all;
}

// The clamp of a target: a hundred times the median magnitude (neural/learning/start_mean.h). The search uses
// that the bits of positive floats have the same order as the floats.
float most_of(uint o) {
  uint low = 0u, high = 0x7f7fffffu;
  const uint all = count_up_to(o, high);
  if (all == 0u) return model.max_target;
  while (low < high) {
    const uint between = low + (high - low) / 2u;
    if (count_up_to(o, between) > all / 2u)
      high = between;
    else
      low = between + 1u;
  }
  return min(model.max_target, 100.0 * uintBitsToFloat(low));
}

// Sum over every kThreads-th record, with compensated summation (Kahan).
float own_sum(uint o, float most) {
  precise float sum = 0.0, lost = 0.0;
  for (uint record = gl_LocalInvocationIndex; record < batch.size; record += kThreads) {
    if (!is_accepted(record)) continue;
    const float target = batch.targets.at[record * model.outputs + o];
    precise const float part = clamp(target, -most, most) - lost;
    precise const float next = sum + part;
    lost = (next - sum) - part;
    sum = next;
  }
  return sum;
}

void main() {
  const bool first_step = model.progress.at[0] == 0u && model.progress.at[1] == 0u;
  if (!first_step || batch.statistics.at[kAccepted] == 0u) return;
  for (uint o = 0u; o < model.outputs; ++o) {
    sums[gl_LocalInvocationIndex] = own_sum(o, most_of(o));
    barrier();
    for (uint half_size = kThreads / 2u; half_size > 0u; half_size /= 2u) {
      if (gl_LocalInvocationIndex < half_size)
        sums[gl_LocalInvocationIndex] += sums[gl_LocalInvocationIndex + half_size];
      barrier();
    }
    if (gl_LocalInvocationIndex == 0u) {
      const float mean = sums[0] / float(batch.statistics.at[kAccepted]);
      model.parameters.at[argument + o] = mean;
      pack_forward(argument + o, mean);
    }
    barrier();
  }
}
