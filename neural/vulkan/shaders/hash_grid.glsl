// The grid of instant-ngp: a cell's eight corners with trilinear weights.

uint hash_entry(HashLevel level, uvec3 cell) {
  const uint number = level.dense != 0u
                          ? cell.x + cell.y * level.resolution + cell.z * level.resolution * level.resolution
                          : cell.x ^ cell.y * 2654435761u ^ cell.z * 805459861u;
  return level.first_node + number % level.entries;
}

// The position in the unit cube, with the same two roundings as in every backend.
vec3 unit_position(vec3 position) {
  const vec3 low = vec3(model.bounds_min[0], model.bounds_min[1], model.bounds_min[2]);
  precise const vec3 offset = position - low;
  precise const vec3 unit = offset * model.inverse_extent;
  return clamp(unit, vec3(0.0), vec3(1.0));
}

void hash_cell(HashLevel level, vec3 position, out uvec3 cell, out vec3 fraction) {
  const vec3 scaled = fma(position, vec3(level.scale), vec3(0.5));
  const vec3 whole = floor(scaled);
  cell = uvec3(whole);
  fraction = scaled - whole;
}

float corner_weight(vec3 fraction, uint corner) {
  const bvec3 upper = notEqual(uvec3(corner) & uvec3(1u, 2u, 4u), uvec3(0u));
  const vec3 w = mix(vec3(1.0) - fraction, fraction, upper);
  return w.x * w.y * w.z;
}

uint corner_node(HashLevel level, uvec3 cell, uint corner) {
  return hash_entry(level, cell + uvec3(corner & 1u, corner >> 1 & 1u, corner >> 2));
}
