#pragma once
// Maps points to nodes of mesh colours or the hash grid, one point per lane. Part of kernel_table.cpp.

#include "base/simd/fused.h"
#include "base/simd/groups.h"
#include "neural/cpu/kernel_prefetch.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural;
using namespace gatelight::neural::cpu;

// A tile's points. The pointers refer to the batch or, if points are missing or not finite, to copies with
// zeros in their place. `finite` is 1 for existing finite points, else 0; `valid` is 1 for those that also
// have storage.
struct TilePoints {
  const uint32_t* surfaces;
  const uint32_t* triangles;
  const float* barycentrics;
  const float* positions;
  alignas(64) float finite[kTile];
  alignas(64) float valid[kTile];
  alignas(64) uint32_t surface_copies[kTile];
  alignas(64) uint32_t triangle_copies[kTile];
  alignas(64) float barycentric_copies[2 * kTile];
  alignas(64) float position_copies[3 * kTile];
};

// The integer barycentrics and weights of a virtual triangle's three nodes (Yuksel et al. 2010). With B = R
// b, i = floor(B), w = B - i, the sum of the fractions w is R - sum(i), an exact integer.
struct VirtualTriangle {
  Int node[3][3];  // [node][corner]
  Float weight[3];
};

GATELIGHT_INLINE VirtualTriangle virtual_triangle(const Float (&b)[3], Int resolution) {
  const Float scale = to_float(resolution);
  Int i[3];
  Float w[3];
  for (int c = 0; c < 3; ++c) {
    const Float scaled = b[c] * scale;
    const Float whole = floor(scaled);
    i[c] = to_int(whole);
    w[c] = scaled - whole;
  }
  Int rest = resolution - (i[0] + i[1] + i[2]);
  // Rounding can leave all three fractions just below one. The point is then on the next node.
  const Mask three = rest == 3u;
  for (int c = 0; c < 3; ++c) i[c] += select_or_zero(three, Int(1u));
  rest = select_or_zero(~three, rest);
  const Mask upright = rest == 1u;
  const Mask inverted = rest == 2u;
  const Mask inside = upright | inverted;

  // In an upright triangle node c is i + e_c with weight w_c, in an inverted one i + 1 - e_c with 1 - w_c.
  // Else the point is on node i.
  for (int c = 0; c < 3; ++c) w[c] = select(inverted, 1.0f - w[c], w[c]);
  const Float inverse = 1.0f / max(w[0] + (w[1] + w[2]), 1e-30f);
  VirtualTriangle t;
  const Int own = select_or_zero(upright, Int(1u));
  const Int other = select_or_zero(inverted, Int(1u));
  for (int n = 0; n < 3; ++n) {
    for (int c = 0; c < 3; ++c) t.node[n][c] = i[c] + (n == c ? own : other);
    t.weight[n] = select(inside, w[n] * inverse, n == 0 ? 1.0f : 0.0f);
  }
  return t;
}

// The surfaces of the lanes. Where they are the same, tables are read once.
struct LaneSurfaces {
  Int number;
  uint32_t leader;  // the first lane's
  bool same;        // all lanes have the leader's
};

struct LaneTopology {
  Int offset, stride, triangle_count;
};

struct LaneLevel {
  Int resolution, vertex_base, corners;
};

// Used for levels with R > 1 only.
struct LaneBases {
  Int edge, interior;
};

GATELIGHT_INLINE LaneTopology lane_topology(const KernelEncoder& e, const LaneSurfaces& surfaces) {
  if (surfaces.same) {
    const GateSurface& one = e.surfaces[surfaces.leader];
    return {one.topology_offset, one.topology_stride, one.triangle_count};
  }
  const uint32_t* words = &e.surfaces->topology_offset;
  const Int at = surfaces.number * 4u;
  return {gather(words, at), gather(words, at + 1u), gather(words, at + 2u)};
}

// The offset of the first word of level l.
GATELIGHT_INLINE Int level_offset(const KernelEncoder& e, const LaneSurfaces& surfaces, uint32_t l) {
  constexpr uint32_t kLevelWords = sizeof(GateSurfaceLevel) / sizeof(uint32_t);
  return (surfaces.number * e.levels + l) * kLevelWords;
}

GATELIGHT_INLINE LaneLevel lane_level(const KernelEncoder& e, const LaneSurfaces& surfaces, uint32_t l) {
  const GateSurfaceLevel* levels = e.surface_levels;
  if (surfaces.same) {
    const GateSurfaceLevel& one = levels[surfaces.leader * e.levels + l];
    return {one.resolution, one.vertex_base, one.corners};
  }
  const Int at = level_offset(e, surfaces, l);
  return {gather(&levels->resolution, at), gather(&levels->vertex_base, at), gather(&levels->corners, at)};
}

GATELIGHT_INLINE LaneBases lane_bases(const KernelEncoder& e, const LaneSurfaces& surfaces, uint32_t l) {
  const GateSurfaceLevel* levels = e.surface_levels;
  if (surfaces.same) {
    const GateSurfaceLevel& one = levels[surfaces.leader * e.levels + l];
    return {one.edge_base, one.interior_base};
  }
  const Int at = level_offset(e, surfaces, l);
  return {gather(&levels->edge_base, at), gather(&levels->interior_base, at)};
}

// The words of the triangles' rows in the topology, read when they are first needed.
struct TopologyRows {
  const uint32_t* topology;
  Int offset = 0u;  // of the rows
  Int corners[3], edges[3];
  Int corners_word = ~0u;  // from which `corners` were read; no word has this number
  bool has_edges = false;

  GATELIGHT_INLINE void read(Int word, Int (&three)[3]) const {
    const Float4 read = Records(offset + word).four(topology, 0);
    for (uint32_t c = 0; c < 3; ++c) three[c] = bits_of(read.c[c]);
  }
  GATELIGHT_INLINE void need_corners(Int word) {
    if (all(word == corners_word)) return;
    read(word, corners);
    corners_word = word;
  }
  GATELIGHT_INLINE void need_edges() {
    if (!has_edges) read(uint32_t{kTopologyEdges}, edges);
    has_edges = true;
  }
};

// Loads barycentrics, and makes them nonnegative with the sum 1.
GATELIGHT_INLINE void load_barycentrics(const float* pairs, Float (&b)[3]) {
  load_pairs(pairs, b[1], b[2]);
  b[0] = 1.0f - b[1] - b[2];
  // Points far outside the triangle stay finite, so that every resulting node exists.
  for (Float& x : b) x = clamp(x, 0.0f, 1e30f);
  const Float inverse = 1.0f / (b[0] + (b[1] + b[2]));
  for (Float& x : b) x *= inverse;
}

// Gives lanes with R = 1 the corners and the barycentrics themselves, as where all lanes have it. So a
// point's bits do not depend on its neighbours.
GATELIGHT_INLINE void use_corners(Mask plain, const Float (&b)[3], VirtualTriangle& t) {
  for (uint32_t n = 0; n < 3; ++n) {
    t.weight[n] = select(plain, b[n], t.weight[n]);
    for (uint32_t c = 0; c < 3; ++c) t.node[n][c] = select(plain, n == c ? 1u : 0u, t.node[n][c]);
  }
}

// Index of the node with integer barycentrics a (gate_tables.h). Only nodes on edges use `edges`.
GATELIGHT_INLINE Int shared_node(const Int (&a)[3], const LaneLevel& level, const LaneBases& bases,
                                 const Int (&corners)[3], const Int (&edges)[3], Int triangle) {
  const Int last = level.resolution - 1u;  // R - 1
  Mask at_zero[3], at_corner[3];
  for (int c = 0; c < 3; ++c) {
    at_zero[c] = a[c] == 0u;
    at_corner[c] = a[c] == level.resolution;
  }
  const Mask vertex = at_corner[0] | at_corner[1] | at_corner[2];
  const Mask edge = at_zero[0] | at_zero[1] | at_zero[2];
  Int node =
      level.vertex_base + select(at_corner[0], corners[0], select(at_corner[1], corners[1], corners[2]));
  if (all(vertex)) return node;

  // The edge is opposite to the corner whose coordinate is zero. Steps from its lower corner equal the
  // coordinate of its higher corner.
  const Mask swap0 = corners[1] < corners[2];
  const Mask swap1 = corners[2] < corners[0];
  const Mask swap2 = corners[0] < corners[1];
  const Int steps0 = select(swap0, a[2], a[1]);
  const Int steps1 = select(swap1, a[0], a[2]);
  const Int steps2 = select(swap2, a[1], a[0]);
  const Int steps = select(at_zero[0], steps0, select(at_zero[1], steps1, steps2));
  const Int number = select(at_zero[0], edges[0], select(at_zero[1], edges[1], edges[2]));
  const Int edge_node = bases.edge + number * last + steps - 1u;

  const Int row = a[0] - 1u;
  const Int interior_count = (last * (last - 1u)) >> 1;
  const Int before = (row * (last + last - a[0])) >> 1;
  const Int interior_node = bases.interior + triangle * interior_count + before + a[1] - 1u;
  return select(vertex, node, select(edge, edge_node, interior_node));
}

GATELIGHT_INLINE Int triangle_node(const Int (&a)[3], const LaneLevel& level, Int triangle) {
  const Int r = level.resolution;
  const Int count = ((r + 1u) * (r + 2u)) >> 1;
  const Int before = (a[0] * (r + r + 3u - a[0])) >> 1;
  return level.vertex_base + triangle * count + before + a[1];
}

// Writes nodes and weights [slot][kTile]. Points without storage get weight 0, and their `valid` becomes 0.
// Returns the number of valid points without storage.
GATELIGHT_NOINLINE uint32_t lookup_gate(const KernelEncoder& e, TilePoints& points, uint32_t* nodes,
                                        float* weights) {
  const bool shared = e.per_triangle == 0;
  uint32_t unstored = 0;
  for (uint32_t s = 0; s < kTile; s += kLanes) {
    const Float valid = load(points.valid + s);
    const Int given = load(points.surfaces + s);
    Mask stored = given < e.surface_count;
    const Int surface = select_or_zero(stored, given);
    const uint32_t leader = surface.v[0];
    const LaneSurfaces surfaces{surface, leader, all(surface == leader)};
    const LaneTopology topology = lane_topology(e, surfaces);
    Int triangle = load(points.triangles + s);
    stored &= triangle < topology.triangle_count;
    Float b[3];
    load_barycentrics(points.barycentrics + 2 * s, b);

    TopologyRows rows{e.topology};
    for (uint32_t l = 0; l < e.levels; ++l) {
      const auto put = [&](uint32_t n, Int node, Float weight) __attribute__((always_inline)) {
        store(nodes + (3 * l + n) * kTile + s, select_or_zero(stored, node));
        store(weights + (3 * l + n) * kTile + s, select_or_zero(stored, valid * weight));
      };
      const LaneLevel level = lane_level(e, surfaces, l);
      if (l == 0) {
        stored &= Int(0u) < level.resolution;
        triangle = select_or_zero(stored, triangle);
        rows.offset = select_or_zero(stored, topology.offset + triangle * topology.stride);
      }
      if (shared) {
        rows.need_corners(level.corners);
        if (all(level.resolution == 1u)) {
          for (uint32_t n = 0; n < 3; ++n) put(n, level.vertex_base + rows.corners[n], b[n]);
          continue;
        }
        rows.need_edges();
      }
      const LaneBases bases = lane_bases(e, surfaces, l);
      VirtualTriangle t = virtual_triangle(b, level.resolution);
      if (shared) use_corners(level.resolution == 1u, b, t);
      for (uint32_t n = 0; n < 3; ++n) {
        const Int node = shared ? shared_node(t.node[n], level, bases, rows.corners, rows.edges, triangle)
                                : triangle_node(t.node[n], level, triangle);
        put(n, node, t.weight[n]);
      }
    }
    if (!all(stored)) {
      const Float left = select_or_zero(~stored, valid);
      unstored += static_cast<uint32_t>(sum(left));
      store(points.valid + s, select_or_zero(stored, valid));
    }
  }
  return unstored;
}

// number mod entries. Entries are a multiple of 8, so a quotient of 29-bit numbers suffices. It is the upper
// half of the product with 2^(32+shift) / (entries / 8), rounded up, which is exact (Granlund, Montgomery
// 1994).
GATELIGHT_INLINE Int modulo(Int number, const KernelHashLevel& level) {
  if ((level.entries & (level.entries - 1)) == 0) return number & (level.entries - 1);
  const Int quotient = multiply_high(number >> 3, level.multiplier) >> static_cast<int>(level.shift);
  return number - quotient * level.entries;
}

// The grid of instant-ngp: points lie at x scale + 0.5 and have eight corners with trilinear weights.
GATELIGHT_NOINLINE void lookup_hash_grid(const KernelEncoder& e, const TilePoints& points, uint32_t* nodes,
                                         float* weights) {
  for (uint32_t s = 0; s < kTile; s += kLanes) {
    const Float valid = load(points.valid + s);
    const Int triples = lane_numbers() * 3u;
    const float* positions = points.positions + 3 * s;
    Float x[3];
    for (uint32_t c = 0; c < 3; ++c) {
      x[c] = (gather(positions + c, triples) - e.bounds_min[c]) * e.inverse_extent;
      x[c] = clamp(x[c], 0.0f, 1.0f);
    }
    for (uint32_t l = 0; l < e.levels; ++l) {
      const KernelHashLevel& level = e.hash_levels[l];
      Int low[3][2];  // each axis's term of the index, for the lower and the upper corner
      Float w[3][2];
      for (uint32_t c = 0; c < 3; ++c) {
        const Float scaled = fma(x[c], level.scale, 0.5f);
        const Float whole = floor(scaled);
        w[c][1] = scaled - whole;
        w[c][0] = 1.0f - w[c][1];
        const Int cell = to_int(whole);
        const Int next = cell + 1u;
        const uint32_t factors[2][3] = {{1u, 2654435761u, 805459861u},
                                        {1u, level.resolution, level.resolution * level.resolution}};
        const Int factor = factors[level.dense][c];
        low[c][0] = cell * factor;
        low[c][1] = next * factor;
      }
#pragma GCC unroll 8
      for (uint32_t k = 0; k < 8; ++k) {
        const Int a = low[0][k & 1], b = low[1][k >> 1 & 1], c = low[2][k >> 2];
        const Int number = level.dense != 0 ? a + b + c : a ^ b ^ c;
        const Int node = level.first_node + modulo(number, level);
        const Float weight = w[0][k & 1] * w[1][k >> 1 & 1] * (w[2][k >> 2] * valid);
        store(nodes + (8 * l + k) * kTile + s, node);
        store(weights + (8 * l + k) * kTile + s, weight);
      }
    }
  }
}

GATELIGHT_INLINE void prefetch_rows(const float* p, uint32_t width, uint64_t begin, uint64_t end) {
  if (p == nullptr) return;
  for (uint64_t i = begin * width; i < end * width; i += 16) prefetch(p + i);
}

// Prefetches the data that the lookups of points [begin, end) read first.
GATELIGHT_NOINLINE void prefetch_points(const KernelEncoder& e, const KernelPoints& points, uint64_t begin,
                                        uint64_t end) {
  prefetch_rows(points.barycentrics, 2, begin, end);
  prefetch_rows(points.positions, 3, begin, end);
  prefetch_rows(points.directions, 3, begin, end);
  prefetch_rows(points.normals, 3, begin, end);
  prefetch_rows(points.albedos, 3, begin, end);
  if (e.encoding != KernelEncoding::gate || e.per_triangle != 0) return;
  for (uint64_t i = begin; i < end; ++i) {
    const uint32_t surface = points.surfaces[i], triangle = points.triangles[i];
    if (surface >= e.surface_count) continue;
    const GateSurface& s = e.surfaces[surface];
    if (triangle >= s.triangle_count) continue;
    const uint32_t* row = e.topology + s.topology_offset + uint64_t{triangle} * s.topology_stride;
    prefetch_far(row);
    if (s.topology_stride > 6) prefetch_far(row + s.topology_stride - 1);
  }
}

}  // namespace
