// Mesh colours (Yuksel, Keyser, House 2010) with the tables of gate_tables.h: a point's three nodes in a
// level.

const uint kTopologyEdges = 3;
const uint kSurfaceWords = 4;
const uint kLevelWords = 5;

struct GateLevel {
  uint resolution;
  uint vertex_base;
  uint edge_base;
  uint interior_base;
  uint corners;
};

struct NodeWeights {
  uvec3 nodes;
  vec3 weights;
};

uint topology_word(uint word) {
  return part_of(model.topology, word).at[place_in_part(model.topology, word)];
}

uvec3 topology_three(uint word) {
  return uvec3(topology_word(word), topology_word(word + 1u), topology_word(word + 2u));
}

GateLevel gate_level(uint surface, uint level) {
  const uint at = (surface * model.level_count + level) * kLevelWords;
  Words words = model.levels;
  return GateLevel(words.at[at], words.at[at + 1u], words.at[at + 2u], words.at[at + 3u], words.at[at + 4u]);
}

// Weights of all three corners. Points far outside stay finite, so that every resulting node exists.
vec3 corner_weights(vec2 second_and_third) {
  const float first = (1.0 - second_and_third.x) - second_and_third.y;
  const vec3 b = clamp(vec3(first, second_and_third), vec3(0.0), vec3(1e30));
  return b * (1.0 / (b.x + (b.y + b.z)));
}

// The small triangle around a point: integer barycentrics of its nodes, and weights. R minus the sum of the
// floors of R b selects the case: 1 is a small triangle with the big one's orientation, 2 an inverted one, 0
// and 3 a node.
void small_triangle(vec3 b, uint resolution, out uvec3 nodes[3], out vec3 weights) {
  const vec3 scaled = b * float(resolution);
  const vec3 whole = floor(scaled);
  uvec3 low = uvec3(whole);
  vec3 w = scaled - whole;
  uint rest = resolution - (low.x + low.y + low.z);
  if (rest == 3u) {  // rounding left all fractions just below one
    low += uvec3(1u);
    rest = 0u;
  }
  if (rest == 2u) w = vec3(1.0) - w;
  const bool inside = rest == 1u || rest == 2u;
  for (uint n = 0u; n < 3u; ++n) {
    nodes[n] = low + (rest == 2u ? uvec3(1u) : uvec3(0u));
    if (rest == 1u) nodes[n][n] += 1u;
    if (rest == 2u) nodes[n][n] -= 1u;
  }
  weights = inside ? w * (1.0 / max(w.x + (w.y + w.z), 1e-30)) : vec3(1.0, 0.0, 0.0);
}

uint triangle_node(uvec3 node, GateLevel level, uint triangle) {
  const uint r = level.resolution;
  return level.vertex_base + triangle * ((r + 1u) * (r + 2u) / 2u) + node.x * (2u * r + 3u - node.x) / 2u +
         node.y;
}

uint shared_node(uvec3 node, GateLevel level, uint row, uint triangle) {
  const uint r = level.resolution;
  if (node.x > 0u && node.y > 0u && node.z > 0u)
    return level.interior_base + triangle * ((r - 1u) * (r - 2u) / 2u) +
           (node.x - 1u) * (2u * (r - 1u) - node.x) / 2u + node.y - 1u;
  const uvec3 corners = topology_three(row + level.corners);
  if (node.x == r) return level.vertex_base + corners.x;
  if (node.y == r) return level.vertex_base + corners.y;
  if (node.z == r) return level.vertex_base + corners.z;
  // The edge is opposite to the corner whose coordinate is 0; steps count from its lower vertex.
  uint edge = 2u, steps = corners.x < corners.y ? node.y : node.x;
  if (node.x == 0u) {
    edge = 0u;
    steps = corners.y < corners.z ? node.z : node.y;
  } else if (node.y == 0u) {
    edge = 1u;
    steps = corners.z < corners.x ? node.x : node.z;
  }
  return level.edge_base + topology_word(row + kTopologyEdges + edge) * (r - 1u) + steps - 1u;
}

NodeWeights gate_nodes(GateLevel level, uint row, uint triangle, vec3 b) {
  if (model.per_triangle == 0u && level.resolution == 1u)
    return NodeWeights(uvec3(level.vertex_base) + topology_three(row + level.corners), b);
  uvec3 nodes[3];
  NodeWeights result;
  small_triangle(b, level.resolution, nodes, result.weights);
  for (uint n = 0u; n < 3u; ++n)
    result.nodes[n] = model.per_triangle != 0u ? triangle_node(nodes[n], level, triangle)
                                               : shared_node(nodes[n], level, row, triangle);
  return result;
}
