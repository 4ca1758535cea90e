#version 460
// Sums weight times gradient over the references of each piece, in their order, and counts the runs. A
// workgroup loads kThreads references together, then each thread sums one feature of a piece.

#include "blocks.glsl"
#include "runs.glsl"

layout(constant_id = 0) const uint kFeatures = 1;
layout(constant_id = 1) const bool kPerTriangle = false;

shared uint nodes[kThreads];
shared float weights[kThreads];
shared uint gradients[kThreads];  // index of the first gradient
shared uint steps[kThreads];      // step counts of the triangles
shared float products[kThreads * kFeatures];
shared uint run_count;

uint triangle_step(uint record) {
  const uint triangle = batch.record_triangles.at[record];
  return part_of(model.triangle_steps, triangle).at[place_in_part(model.triangle_steps, triangle)];
}

void load_reference(uint i) {
  const uint t = gl_LocalInvocationIndex, slots = model.level_count * model.nodes_per_level;
  const uvec2 own = i < batch.references ? batch.sorted[argument].at[i] : uvec2(model.node_count, 0u);
  nodes[t] = own.x;
  if (own.x >= model.node_count) return;
  const uint record = own.y / slots, level = own.y % slots / model.nodes_per_level;
  weights[t] = batch.weights.at[own.y];
  gradients[t] = record * model.feature_inputs + level * kFeatures;
  if (kPerTriangle) steps[t] = triangle_step(record);
  if (begins_run(i)) atomicAdd(run_count, 1u);
}

bool begins_piece(uint r) {
  return nodes[r] < model.node_count && (r % kPiece == 0u || nodes[r - 1u] != nodes[r]);
}

void sum_piece(uint window, uint r, uint feature) {
  uint end = r;
  float sum = 0.0;
  uint greatest = 0u;
  do {
    sum += products[end * kFeatures + feature];
    if (kPerTriangle) greatest = max(greatest, steps[end]);
    ++end;
  } while (end % kPiece != 0u && nodes[end] == nodes[r]);
  batch.piece_sums.at[(window + r) * kFeatures + feature] = sum;
  if (kPerTriangle && feature == 0u) batch.piece_steps.at[window + r] = greatest;
}

void main() {
  const uint t = gl_LocalInvocationIndex, groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  if (t == 0u) run_count = 0u;
  barrier();
  for (uint window = flat_group() * kThreads; window < batch.references; window += groups * kThreads) {
    load_reference(window + t);
    barrier();
    for (uint item = t; item < kThreads * kFeatures; item += kThreads) {
      const uint r = item / kFeatures;
      if (nodes[r] < model.node_count)
        products[item] = weights[r] * batch.feature_gradients.at[gradients[r] + item % kFeatures];
    }
    barrier();
    for (uint item = t; item < kThreads * kFeatures; item += kThreads)
      if (begins_piece(item / kFeatures)) sum_piece(window, item / kFeatures, item % kFeatures);
    barrier();
  }
  if (t == 0u && run_count != 0u) atomicAdd(batch.statistics.at[kTouched], run_count);
}
