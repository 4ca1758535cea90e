#version 460
// Sums weight times gradient over the references of each piece, in their order, one feature per thread.

#include "blocks.glsl"

layout(constant_id = 0) const uint kFeatures = 1;
layout(constant_id = 1) const bool kPerTriangle = false;

// The largest step count of the triangles of the piece's records.
uint greatest_triangle_step(uint begin, uint end, uint slots) {
  uint greatest = 0u;
  for (uint i = begin; i < end; ++i) {
    const uint record = batch.values[argument].at[i] / slots;
    const uint triangle = batch.record_triangles.at[record];
    const uint steps = part_of(model.triangle_steps, triangle).at[place_in_part(model.triangle_steps, triangle)];
    greatest = max(greatest, steps);
  }
  return greatest;
}

void main() {
  const uint slots = model.level_count * model.nodes_per_level;
  const uint all = batch.statistics.at[kPieces] * kFeatures;
  const uint threads = gl_NumWorkGroups.x * gl_NumWorkGroups.y * kThreads;
  for (uint item = flat_thread(); item < all; item += threads) {
    const uint piece = item / kFeatures, feature = item % kFeatures;
    const uint begin = batch.piece_starts.at[piece], end = batch.piece_starts.at[piece + 1u];
    float sum = 0.0;
    for (uint i = begin; i < end; ++i) {
      const uint reference = batch.values[argument].at[i];
      const uint record = reference / slots, level = reference % slots / model.nodes_per_level;
      const uint at = record * model.feature_inputs + level * kFeatures + feature;
      sum += batch.weights.at[reference] * batch.feature_gradients.at[at];
    }
    batch.piece_sums.at[item] = sum;
    if (kPerTriangle && feature == 0u)
      batch.piece_steps.at[piece] = greatest_triangle_step(begin, end, slots);
  }
}
