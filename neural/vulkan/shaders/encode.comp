#version 460
// Encodes training records as network inputs, one record per thread: its status, its nodes and weights, and
// the inputs.

#include "blocks.glsl"
#include "gate.glsl"
#include "halves.glsl"
#include "hash_grid.glsl"
#include "inputs.glsl"

layout(constant_id = 0) const uint kEncoding = 0;  // none, gate, hash grid
layout(constant_id = 1) const bool kHalves = false;
layout(constant_id = 2) const uint kFeatures = 1;
const bool kTraining = true;

// Counts a workgroup's records by status, so that each workgroup needs only one global addition per status.
shared uint status_counts[3];

uint record;

void put(uint row, float value) {
  batch.inputs.at[row * batch.capacity + record] = value;
}

void put_reference(uint slot, uint node, float weight) {
  const uint at = record * (model.level_count * model.nodes_per_level) + slot;
  batch.keys.at[at] = weight != 0.0 ? node : model.node_count;
  batch.weights.at[at] = weight;
}

#include "encode.glsl"

uint encode() {
  const uint status = status_of_record();
  if (status == kStatusRejected) {
    for (uint l = 0u; l < model.level_count; ++l) encode_no_features(l);
    for (uint i = model.feature_inputs; i < model.inputs; ++i) put(i, 0.0);
    return status;
  }
  for (uint part = 0u; part < parts_to_encode(); ++part) encode_part(part, status);
  if (kEncoding == kGate && status == kStatusAccepted)
    batch.record_triangles.at[record] =
        model.surfaces.at[batch.surfaces.at[record] * kSurfaceWords + 3u] + batch.triangles.at[record];
  return status;
}

void main() {
  record = flat_thread();
  if (gl_LocalInvocationIndex < 3u) status_counts[gl_LocalInvocationIndex] = 0u;
  barrier();
  if (record < batch.size) {
    const uint status = encode();
    batch.status.at[record] = status;
    atomicAdd(status_counts[status], 1u);
  }
  barrier();
  if (gl_LocalInvocationIndex < 3u)
    atomicAdd(batch.statistics.at[kAccepted + gl_LocalInvocationIndex], status_counts[gl_LocalInvocationIndex]);
}
