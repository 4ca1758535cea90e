#pragma once
// Maps points to nodes of mesh colours or the hash grid, one point per lane. Part of kernel_table.cpp.

#include "neural/cpu/kernels.h"
#include "neural/cpu/simd.h"

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
    const Float scaled = mul(b[c], scale);
    const Float whole = floor(scaled);
    i[c] = to_int(whole);
    w[c] = sub(scaled, whole);
  }
  const Int one = broadcast_int(1);
  Int rest = sub_int(resolution, add_int(i[0], add_int(i[1], i[2])));
  // Rounding can leave all three fractions just below one. The point is then on the next node.
  const Mask three = equal_int(rest, broadcast_int(3));
  for (int c = 0; c < 3; ++c) i[c] = add_int(i[c], select_int(three, one, broadcast_int(0)));
  rest = select_int(three, broadcast_int(0), rest);
  const Mask upright = equal_int(rest, one);
  const Mask inverted = equal_int(rest, broadcast_int(2));
  const Mask inside = either(upright, inverted);

  // In an upright triangle node c is i + e_c with weight w_c, in an inverted one i + 1 - e_c with 1 - w_c.
  // Else the point is on node i.
  for (int c = 0; c < 3; ++c) w[c] = select(inverted, sub(broadcast(1.0f), w[c]), w[c]);
  const Float inverse = div(broadcast(1.0f), max(add(w[0], add(w[1], w[2])), broadcast(1e-30f)));
  VirtualTriangle t;
  const Int own = select_int(upright, one, broadcast_int(0));
  const Int other = select_int(inverted, one, broadcast_int(0));
  for (int n = 0; n < 3; ++n) {
    for (int c = 0; c < 3; ++c) t.node[n][c] = add_int(i[c], n == c ? own : other);
    t.weight[n] = select(inside, mul(w[n], inverse), broadcast(n == 0 ? 1.0f : 0.0f));
  }
  return t;
}

struct LaneLevel {
  Int resolution, vertex_base, corners;
};

// Used for levels with R > 1 only.
struct LaneBases {
  Int edge, interior;
};

constexpr uint32_t kLevelWords = sizeof(GateSurfaceLevel) / sizeof(uint32_t);

GATELIGHT_INLINE LaneLevel lane_level(const GateSurfaceLevel& level) {
  return {broadcast_int(level.resolution), broadcast_int(level.vertex_base), broadcast_int(level.corners)};
}

GATELIGHT_INLINE LaneBases lane_bases(const GateSurfaceLevel& level) {
  return {broadcast_int(level.edge_base), broadcast_int(level.interior_base)};
}

// `at` is the offset of the level's first word.
GATELIGHT_INLINE LaneLevel gather_level(const GateSurfaceLevel* levels, Int at) {
  return {gather_int(&levels->resolution, at), gather_int(&levels->vertex_base, at),
          gather_int(&levels->corners, at)};
}

GATELIGHT_INLINE LaneBases gather_bases(const GateSurfaceLevel* levels, Int at) {
  return {gather_int(&levels->edge_base, at), gather_int(&levels->interior_base, at)};
}

// Index of the node with integer barycentrics a (gate_tables.h). Only nodes on edges use `edges`.
GATELIGHT_INLINE Int shared_node(const Int (&a)[3], const LaneLevel& level, const LaneBases& bases,
                                 const Int (&corners)[3], const Int (&edges)[3], Int triangle) {
  const Int none = broadcast_int(0);
  const Int one = broadcast_int(1);
  const Int last = sub_int(level.resolution, one);  // R - 1
  Mask at_zero[3], at_corner[3];
  for (int c = 0; c < 3; ++c) {
    at_zero[c] = equal_int(a[c], none);
    at_corner[c] = equal_int(a[c], level.resolution);
  }
  const Mask vertex = either(at_corner[0], either(at_corner[1], at_corner[2]));
  const Mask edge = either(at_zero[0], either(at_zero[1], at_zero[2]));
  Int node = add_int(level.vertex_base,
                     select_int(at_corner[0], corners[0], select_int(at_corner[1], corners[1], corners[2])));
  if (all(vertex)) return node;

  // The edge is opposite to the corner whose coordinate is zero. Steps from its lower corner equal the
  // coordinate of its higher corner.
  const Mask swap0 = less_unsigned(corners[1], corners[2]);
  const Mask swap1 = less_unsigned(corners[2], corners[0]);
  const Mask swap2 = less_unsigned(corners[0], corners[1]);
  const Int steps0 = select_int(swap0, a[2], a[1]);
  const Int steps1 = select_int(swap1, a[0], a[2]);
  const Int steps2 = select_int(swap2, a[1], a[0]);
  const Int steps = select_int(at_zero[0], steps0, select_int(at_zero[1], steps1, steps2));
  const Int number = select_int(at_zero[0], edges[0], select_int(at_zero[1], edges[1], edges[2]));
  const Int edge_node = add_int(bases.edge, add_int(mul_int(number, last), sub_int(steps, one)));

  const Int row = sub_int(a[0], one);
  const Int interior_count = half_int(mul_int(last, sub_int(last, one)));
  const Int before = half_int(mul_int(row, sub_int(add_int(last, last), a[0])));
  const Int interior_node = add_int(
      bases.interior, add_int(mul_int(triangle, interior_count), add_int(before, sub_int(a[1], one))));
  return select_int(vertex, node, select_int(edge, edge_node, interior_node));
}

GATELIGHT_INLINE Int triangle_node(const Int (&a)[3], const LaneLevel& level, Int triangle) {
  const Int r = level.resolution;
  const Int one = broadcast_int(1);
  const Int count = half_int(mul_int(add_int(r, one), add_int(r, broadcast_int(2))));
  const Int before = half_int(mul_int(a[0], sub_int(add_int(add_int(r, r), broadcast_int(3)), a[0])));
  return add_int(level.vertex_base, add_int(mul_int(triangle, count), add_int(before, a[1])));
}

// Writes nodes and weights [slot][kTile]. Points without storage get weight 0, and their `valid` becomes 0.
// Returns the number of valid points without storage.
GATELIGHT_ALONE uint32_t lookup_gate(const KernelEncoder& e, TilePoints& points, uint32_t* nodes,
                                     float* weights) {
  uint32_t unstored = 0;
  const uint32_t* words = &e.surfaces->topology_offset;
  for (uint32_t s = 0; s < kTile; s += kLanes) {
    const Float valid = load(points.valid + s);
    Int surface = load_int(points.surfaces + s);
    Mask stored = less_unsigned(surface, broadcast_int(e.surface_count));
    surface = select_int(stored, surface, broadcast_int(0));
    const uint32_t leader = first_lane(surface);
    const bool same = all(equal_int(surface, broadcast_int(leader)));

    Int offset, stride, count;
    if (same) {
      const GateSurface& one = e.surfaces[leader];
      offset = broadcast_int(one.topology_offset);
      stride = broadcast_int(one.topology_stride);
      count = broadcast_int(one.triangle_count);
    } else {
      const Int at = mul_int(surface, broadcast_int(4));
      offset = gather_int(words, at);
      stride = gather_int(words, add_int(at, broadcast_int(1)));
      count = gather_int(words, add_int(at, broadcast_int(2)));
    }
    Int triangle = load_int(points.triangles + s);
    stored = both(stored, less_unsigned(triangle, count));

    Float b[3];
    load_pairs(points.barycentrics + 2 * s, b[1], b[2]);
    b[0] = sub(sub(broadcast(1.0f), b[1]), b[2]);
    // Points far outside the triangle stay finite, so that every resulting node exists.
    for (Float& x : b) x = min(max(x, zero()), broadcast(1e30f));
    const Float inverse = div(broadcast(1.0f), add(b[0], add(b[1], b[2])));
    for (Float& x : b) x = mul(x, inverse);

    Int corners[3], edges[3];
    Int corners_read = broadcast_int(0);  // the row's word that `corners` was read from
    Int row = broadcast_int(0);
    bool edges_read = false;
    alignas(64) uint32_t places[kLanes];
    const auto read_row = [&](Int first, Int(&three)[3]) __attribute__((always_inline)) {
      store_int(places, add_int(row, first));
      Int columns[4];
      load_columns4(
          [&](uint32_t i) __attribute__((always_inline)) { return e.topology + places[i]; }, columns);
      for (uint32_t c = 0; c < 3; ++c) three[c] = columns[c];
    };
    for (uint32_t l = 0; l < e.levels; ++l) {
      const GateSurfaceLevel& one = e.surface_levels[leader * e.levels + l];
      const Int at = mul_int(add_int(mul_int(surface, broadcast_int(e.levels)), broadcast_int(l)),
                             broadcast_int(kLevelWords));
      const LaneLevel level = same ? lane_level(one) : gather_level(e.surface_levels, at);
      if (l == 0) {
        stored = both(stored, less_unsigned(broadcast_int(0), level.resolution));
        triangle = select_int(stored, triangle, broadcast_int(0));
        row = select_int(stored, add_int(offset, mul_int(triangle, stride)), broadcast_int(0));
      }
      if (e.per_triangle == 0 && (l == 0 || !all(equal_int(level.corners, corners_read)))) {
        read_row(level.corners, corners);
        corners_read = level.corners;
      }
      // If all lanes have R = 1, the nodes are the corners.
      if (e.per_triangle == 0 && all(equal_int(level.resolution, broadcast_int(1)))) {
        for (uint32_t n = 0; n < 3; ++n) {
          const Int node = add_int(level.vertex_base, corners[n]);
          store_int(nodes + (3 * l + n) * kTile + s, select_int(stored, node, broadcast_int(0)));
          store(weights + (3 * l + n) * kTile + s, select(stored, mul(valid, b[n]), zero()));
        }
        continue;
      }
      if (e.per_triangle == 0 && !edges_read) {
        read_row(broadcast_int(kTopologyEdges), edges);
        edges_read = true;
      }
      const LaneBases bases = same ? lane_bases(one) : gather_bases(e.surface_levels, at);
      VirtualTriangle t = virtual_triangle(b, level.resolution);
      if (e.per_triangle == 0) {
        // Lanes with R = 1 get the same values as above, so that a point's bits do not depend on its
        // neighbours.
        const Mask plain = equal_int(level.resolution, broadcast_int(1));
        for (uint32_t n = 0; n < 3; ++n) {
          t.weight[n] = select(plain, b[n], t.weight[n]);
          for (uint32_t c = 0; c < 3; ++c)
            t.node[n][c] = select_int(plain, broadcast_int(n == c ? 1 : 0), t.node[n][c]);
        }
      }
      for (uint32_t n = 0; n < 3; ++n) {
        const Int node = e.per_triangle != 0 ? triangle_node(t.node[n], level, triangle)
                                             : shared_node(t.node[n], level, bases, corners, edges, triangle);
        const Float weight = mul(valid, t.weight[n]);
        store_int(nodes + (3 * l + n) * kTile + s, select_int(stored, node, broadcast_int(0)));
        store(weights + (3 * l + n) * kTile + s, select(stored, weight, zero()));
      }
    }
    if (!all(stored)) {
      const Float left = select(stored, zero(), valid);
      unstored += static_cast<uint32_t>(sum(left));
      store(points.valid + s, select(stored, valid, zero()));
    }
  }
  return unstored;
}

// number mod entries. Entries are a multiple of 8, so a quotient of 29-bit numbers suffices. It is the upper
// half of the product with 2^(32+shift) / (entries / 8), rounded up, which is exact (Granlund, Montgomery
// 1994).
GATELIGHT_INLINE Int modulo(Int number, const KernelHashLevel& level) {
  if ((level.entries & (level.entries - 1)) == 0) return and_int(number, broadcast_int(level.entries - 1));
  const Int quotient =
      shift_right(multiply_high(shift_right(number, 3), broadcast_int(level.multiplier)), level.shift);
  return sub_int(number, mul_int(quotient, broadcast_int(level.entries)));
}

// The grid of instant-ngp: points lie at x scale + 0.5 and have eight corners with trilinear weights.
GATELIGHT_ALONE void lookup_hash_grid(const KernelEncoder& e, const TilePoints& points, uint32_t* nodes,
                                      float* weights) {
  for (uint32_t s = 0; s < kTile; s += kLanes) {
    const Float valid = load(points.valid + s);
    const Int triples = add_int(lane_numbers(), add_int(lane_numbers(), lane_numbers()));
    Float x[3];
    for (uint32_t c = 0; c < 3; ++c) {
      x[c] = mul(sub(gather(points.positions + 3 * s + c, triples), broadcast(e.bounds_min[c])),
                 broadcast(e.inverse_extent));
      x[c] = clamp(x[c], 0.0f, 1.0f);
    }
    for (uint32_t l = 0; l < e.levels; ++l) {
      const KernelHashLevel& level = e.hash_levels[l];
      Int low[3][2];  // each axis's term of the index, for the lower and the upper corner
      Float w[3][2];
      for (uint32_t c = 0; c < 3; ++c) {
        const Float scaled = fma(x[c], broadcast(level.scale), broadcast(0.5f));
        const Float whole = floor(scaled);
        w[c][1] = sub(scaled, whole);
        w[c][0] = sub(broadcast(1.0f), w[c][1]);
        const Int cell = to_int(whole);
        const Int next = add_int(cell, broadcast_int(1));
        const uint32_t factors[2][3] = {{1u, 2654435761u, 805459861u},
                                        {1u, level.resolution, level.resolution * level.resolution}};
        const Int factor = broadcast_int(factors[level.dense][c]);
        low[c][0] = mul_int(cell, factor);
        low[c][1] = mul_int(next, factor);
      }
      for (uint32_t k = 0; k < 8; ++k) {
        const Int a = low[0][k & 1], b = low[1][k >> 1 & 1], c = low[2][k >> 2];
        const Int number = level.dense != 0 ? add_int(a, add_int(b, c)) : xor_int(a, xor_int(b, c));
        const Int node = add_int(broadcast_int(level.first_node), modulo(number, level));
        const Float weight = mul(mul(w[0][k & 1], w[1][k >> 1 & 1]), mul(w[2][k >> 2], valid));
        store_int(nodes + (8 * l + k) * kTile + s, node);
        store(weights + (8 * l + k) * kTile + s, weight);
      }
    }
  }
}

GATELIGHT_INLINE void prefetch_rows(const float* p, uint32_t width, uint64_t begin, uint64_t end) {
  if (p == nullptr) return;
  for (uint64_t i = begin * width; i < end * width; i += 16) prefetch(p + i);
}

// Prefetches what the lookups of points [begin, end) read first.
GATELIGHT_ALONE void prefetch_points(const KernelEncoder& e, const KernelPoints& points, uint64_t begin,
                                     uint64_t end) {
  prefetch_rows(points.barycentrics, 2, begin, end);
  prefetch_rows(points.positions, 3, begin, end);
  prefetch_rows(points.directions, 3, begin, end);
  prefetch_rows(points.normals, 3, begin, end);
  prefetch_rows(points.albedos, 3, begin, end);
  if (e.encoding != KernelEncoding::gate || e.per_triangle != 0) return;
  const GateSurface* surfaces = e.surfaces;
  const uint32_t* topology = e.topology;
  const uint32_t surface_count = e.surface_count;
  const uint32_t* point_surfaces = points.surfaces;
  const uint32_t* point_triangles = points.triangles;
  for (uint64_t i = begin; i < end; ++i) {
    const uint32_t surface = point_surfaces[i], triangle = point_triangles[i];
    if (surface >= surface_count) continue;
    const GateSurface& s = surfaces[surface];
    if (triangle >= s.triangle_count) continue;
    const uint32_t* row = topology + s.topology_offset + uint64_t{triangle} * s.topology_stride;
    prefetch_far(row);
    if (s.topology_stride > 6) prefetch_far(row + s.topology_stride - 1);
  }
}

}  // namespace
