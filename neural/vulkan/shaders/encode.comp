#version 460
// Encodes points as network inputs, one point per thread: the status of the record, its nodes and weights,
// the interpolated features and the other inputs.

#include "blocks.glsl"
#include "gate.glsl"
#include "halves.glsl"
#include "hash_grid.glsl"
#include "inputs.glsl"

layout(constant_id = 0) const uint kEncoding = 0;  // none, gate, hash grid
layout(constant_id = 1) const bool kHalves = false;
layout(constant_id = 2) const bool kTraining = false;
layout(constant_id = 3) const uint kFeatures = 1;

const uint kGate = 1;
const uint kHashGrid = 2;
const uint kPosition = 0, kDirection = 1, kNormal = 2, kAlbedo = 3, kRoughness = 4;

// Counts a workgroup's records by status, so that each workgroup needs only one global addition per status.
shared uint status_counts[3];

uint record;

bool reads(uint source) {
  return (model.sources >> source & 1u) != 0u;
}

vec3 three(Floats values) {
  return vec3(values.at[3u * record], values.at[3u * record + 1u], values.at[3u * record + 2u]);
}

vec3 source_values(uint source) {
  if (source == kPosition) return three(batch.positions);
  if (source == kDirection) return three(batch.directions);
  if (source == kNormal) return three(batch.normals);
  if (source == kAlbedo) return three(batch.albedos);
  return vec3(batch.roughnesses.at[record], 0.0, 0.0);
}

vec2 barycentrics() {
  return vec2(batch.barycentrics.at[2u * record], batch.barycentrics.at[2u * record + 1u]);
}

bool finite3(vec3 v) {
  return finite(v.x) && finite(v.y) && finite(v.z);
}

bool all_finite() {
  for (uint source = kPosition; source <= kRoughness; ++source)
    if (reads(source) && !finite3(source_values(source))) return false;
  if (reads(kBarycentricsSource) && !finite3(vec3(barycentrics(), 0.0))) return false;
  if (kTraining)
    for (uint o = 0u; o < model.outputs; ++o)
      if (!finite(batch.targets.at[record * model.outputs + o])) return false;
  return true;
}

void put(uint row, float value) {
  batch.inputs.at[row * batch.capacity + record] = value;
}

// Features first .. first + 3 of a node, zeros behind the last.
vec4 four_features(uint node, uint first) {
  Words part = part_of(batch.read, node);
  const uint at = place_in_part(batch.read, node);
  if (!kHalves && kFeatures % 4u == 0u) return Vectors(part).at[(at + first) / 4u];
  vec4 result = vec4(0.0);
  for (uint k = 0u; k < 4u && first + k < kFeatures; ++k) {
    if (kHalves) {
      const uint word = part.at[at + (first + k) / 2u];
      result[k] = (first + k) % 2u == 0u ? first_half(word) : second_half(word);
    } else {
      result[k] = uintBitsToFloat(part.at[at + first + k]);
    }
  }
  return result;
}

void put_four(uint level, uint first, vec4 z) {
  for (uint k = 0u; k < 4u && first + k < kFeatures; ++k) put(level * kFeatures + first + k, z[k]);
}

void put_reference(uint slot, uint node, float weight) {
  if (!kTraining) return;
  const uint at = record * (model.level_count * model.nodes_per_level) + slot;
  batch.keys[0].at[at] = weight != 0.0 ? node : model.node_count;
  batch.weights.at[at] = weight;
}

void put_no_features() {
  for (uint slot = 0u; slot < model.level_count * model.nodes_per_level; ++slot) put_reference(slot, 0u, 0.0);
  for (uint i = 0u; i < model.feature_inputs; ++i) put(i, 0.0);
}

void encode_gate(uint surface, uint triangle) {
  const vec3 b = corner_weights(barycentrics());
  const uint offset = model.surfaces.at[surface * kSurfaceWords];
  const uint row = offset + triangle * model.surfaces.at[surface * kSurfaceWords + 1u];
  for (uint l = 0u; l < model.level_count; ++l) {
    const NodeWeights n = gate_nodes(gate_level(surface, l), row, triangle, b);
    for (uint k = 0u; k < 3u; ++k) put_reference(3u * l + k, n.nodes[k], n.weights[k]);
    for (uint f = 0u; f < kFeatures; f += 4u) {
      vec4 z = four_features(n.nodes.x, f) * n.weights.x;
      z += four_features(n.nodes.y, f) * n.weights.y;
      z += four_features(n.nodes.z, f) * n.weights.z;
      put_four(l, f, z);
    }
  }
}

void encode_hash_grid() {
  const vec3 position = unit_position(three(batch.positions));
  for (uint l = 0u; l < model.level_count; ++l) {
    const HashLevel level = model.hash_levels[l];
    uvec3 cell;
    vec3 fraction;
    hash_cell(level, position, cell, fraction);
    vec4 z[(kFeatures + 3u) / 4u];
    for (uint f = 0u; f < kFeatures; f += 4u) z[f / 4u] = vec4(0.0);
    for (uint corner = 0u; corner < 8u; ++corner) {
      const uint node = corner_node(level, cell, corner);
      const float weight = corner_weight(fraction, corner);
      put_reference(8u * l + corner, node, weight);
      for (uint f = 0u; f < kFeatures; f += 4u) z[f / 4u] += four_features(node, f) * weight;
    }
    for (uint f = 0u; f < kFeatures; f += 4u) put_four(l, f, z[f / 4u]);
  }
}

void encode_auxiliary(Auxiliary a) {
  vec3 x = source_values(a.source);
  if (a.source == kPosition) x = unit_position(x);
  if (a.transform == kSphericalOneBlob) x = vec3(spherical(x), 0.0);
  for (uint c = 0u; c < a.coordinates; ++c) {
    if (a.transform == kIdentity) {
      put(a.first_input + c, x[c]);
      continue;
    }
    const bool wraps = a.transform == kSphericalOneBlob && c == 1u;
    for (uint bin = 0u; bin < a.size; ++bin)
      put(a.first_input + c * a.size + bin, one_blob(x[c], bin, a.size, wraps));
  }
}

bool is_stored(uint surface, uint triangle) {
  return surface < model.surface_count && triangle < model.surfaces.at[surface * kSurfaceWords + 2u] &&
         gate_level(surface, 0u).resolution != 0u;
}

uint encode_nothing() {
  put_no_features();
  for (uint i = model.feature_inputs; i < model.inputs; ++i) put(i, 0.0);
  return kStatusRejected;
}

uint encode() {
  if (!all_finite()) return encode_nothing();
  uint status = kStatusAccepted;
  if (kEncoding == kGate) {
    const uint surface = batch.surfaces.at[record], triangle = batch.triangles.at[record];
    if (is_stored(surface, triangle)) {
      encode_gate(surface, triangle);
      if (kTraining)
        batch.record_triangles.at[record] = model.surfaces.at[surface * kSurfaceWords + 3u] + triangle;
    } else {
      status = kStatusUnstored;
      put_no_features();
    }
  } else if (kEncoding == kHashGrid) {
    encode_hash_grid();
  }
  for (uint a = 0u; a < model.auxiliary_count; ++a) encode_auxiliary(model.auxiliary[a]);
  return status;
}

void main() {
  record = flat_thread();
  if (gl_LocalInvocationIndex < 3u) status_counts[gl_LocalInvocationIndex] = 0u;
  barrier();
  if (record < batch.size) {
    const uint status = encode();
    batch.status.at[record] = status;
    if (kTraining) atomicAdd(status_counts[status], 1u);
  }
  barrier();
  if (kTraining && gl_LocalInvocationIndex < 3u)
    atomicAdd(batch.statistics.at[kAccepted + gl_LocalInvocationIndex], status_counts[gl_LocalInvocationIndex]);
}
