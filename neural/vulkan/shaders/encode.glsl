// Encodes a point as network inputs: the interpolated features of each level, and the other inputs. The
// including shader declares kTraining, kEncoding, kHalves and kFeatures, the number of the record, and the
// functions put (an input) and put_reference (a node and its weight).

const uint kGate = 1;
const uint kHashGrid = 2;
const uint kPosition = 0, kDirection = 1, kNormal = 2, kAlbedo = 3, kRoughness = 4;

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

bool is_stored(uint surface, uint triangle) {
  return surface < model.surface_count && triangle < model.surfaces.at[surface * kSurfaceWords + 2u] &&
         gate_level(surface, 0u).resolution != 0u;
}

uint status_of_record() {
  if (!all_finite()) return kStatusRejected;
  if (kEncoding == kGate && !is_stored(batch.surfaces.at[record], batch.triangles.at[record])) return kStatusUnstored;
  return kStatusAccepted;
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

void encode_gate(uint l) {
  const uint surface = batch.surfaces.at[record], triangle = batch.triangles.at[record];
  const uint offset = model.surfaces.at[surface * kSurfaceWords];
  const uint row = offset + triangle * model.surfaces.at[surface * kSurfaceWords + 1u];
  const NodeWeights n = gate_nodes(gate_level(surface, l), row, triangle, corner_weights(barycentrics()));
  for (uint k = 0u; k < 3u; ++k) put_reference(3u * l + k, n.nodes[k], n.weights[k]);
  for (uint f = 0u; f < kFeatures; f += 4u) {
    vec4 z = four_features(n.nodes.x, f) * n.weights.x;
    z += four_features(n.nodes.y, f) * n.weights.y;
    z += four_features(n.nodes.z, f) * n.weights.z;
    put_four(l, f, z);
  }
}

void encode_hash_grid(uint l) {
  const HashLevel level = model.hash_levels[l];
  uvec3 cell;
  vec3 fraction;
  hash_cell(level, unit_position(three(batch.positions)), cell, fraction);
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

void encode_no_features(uint l) {
  for (uint k = 0u; k < model.nodes_per_level; ++k) put_reference(model.nodes_per_level * l + k, 0u, 0.0);
  for (uint f = 0u; f < kFeatures; ++f) put(l * kFeatures + f, 0.0);
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

// Encoding has parts: each level, then each other source. Returns the number of parts.
uint parts_to_encode() {
  return model.level_count + model.auxiliary_count;
}

// The record must be accepted or unstored.
void encode_part(uint part, uint status) {
  if (part >= model.level_count)
    encode_auxiliary(model.auxiliary[part - model.level_count]);
  else if (status == kStatusUnstored)
    encode_no_features(part);
  else if (kEncoding == kGate)
    encode_gate(part);
  else if (kEncoding == kHashGrid)
    encode_hash_grid(part);
}
