#version 460
// Sums the weight gradients of all workgroups in one order, then applies Adam and packs the result. A workgroup
// has 8 parameters with sixteen threads each; a thread adds every sixteenth sum.

#define GATELIGHT_SHAPE_OF_MODEL
#include "blocks.glsl"
#include "adam.glsl"
#include "pack.glsl"

const uint kSlices = 16;
const uint kColumns = kThreads / kSlices;

shared float slice_sums[kThreads];

void update(uint p, float sum) {
  const float before = model.parameters.at[p];
  const float g = sum * gradient_scale() + (p < flat_biases(layer_of(p)) ? model.adam.l2_network * before : 0.0);
  if (!finite(g * g)) {
    atomicAdd(batch.statistics.at[kSkipped], 1u);
    return;
  }
  const AdamStep step = adam_step_of_network();
  const float m = model.adam.beta1 * model.first_moments.at[p] + (1.0 - model.adam.beta1) * g;
  const float v = model.adam.beta2 * model.second_moments.at[p] + (1.0 - model.adam.beta2) * g * g;
  const float after = before - moved(m, v, step);
  model.first_moments.at[p] = m;
  model.second_moments.at[p] = v;
  model.parameters.at[p] = after;
  pack_forward(p, after);
  pack_backward(p, after);
  if (model.adam.average_network != 0u) {
    const float average = model.network_average.at[p];
    model.network_average.at[p] = average + step.average_rate * (after - average);
  }
}

void main() {
  if (batch.statistics.at[kAccepted] == 0u) return;
  const uint column = gl_LocalInvocationIndex % kColumns, slice = gl_LocalInvocationIndex / kColumns;
  const uint p = flat_group() * kColumns + column;
  float sum = 0.0;
  if (p < model.network_count)
    for (uint g = slice; g < batch.groups; g += kSlices) sum += batch.partials.at[g * model.network_count + p];
  slice_sums[gl_LocalInvocationIndex] = sum;
  barrier();
  if (slice != 0u || p >= model.network_count) return;
  for (uint s = 1u; s < kSlices; ++s) sum += slice_sums[s * kColumns + column];
  update(p, sum);
}
