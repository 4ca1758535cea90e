#pragma once
// The tables that map a point on a surface to its nodes. CPU kernels and compute shaders read the same words.

#include <stdint.h>

namespace gatelight::neural {

/// The topology of a surface. Triangle t's row starts at topology[topology_offset + t * topology_stride]. A
/// row consists of groups of three words, one per corner:
/// - the triangle's vertices, if a level uses vertices as corners;
/// - its edges, if a level has R > 1; edge c is opposite to corner c;
/// - the clusters of its vertices, for each cell size that a level is clustered with.
/// Surfaces without a clustered level share the table of their mesh, which has edges if one of them needs
/// edges. All these numbers are relative to the bases of the level. An edge runs from its vertex with the
/// lower number to the one with the higher number. An edge between equal vertices, of a degenerate triangle,
/// runs from corner c+2 to c+1 (modulo 3). With `per_triangle` there is no topology.
struct GateSurface {
  uint32_t topology_offset = 0;
  uint32_t topology_stride = 3;  ///< a multiple of 3
  uint32_t triangle_count = 0;
  uint32_t first_triangle = 0;  ///< index of the surface's triangle 0 among all triangles with storage
};

/// Word of the edges in a row, if the surface has a level with R > 1. Such levels use vertices as corners,
/// which are at word 0.
constexpr uint32_t kTopologyEdges = 3;

/// One level of one surface, at levels[surface * stack + level]. R = 0 means no storage. Node (i,j,k) has the
/// integer barycentrics i, j, k of corners 0, 1, 2, with the sum R.
/// Shared storage: corner c's node is vertex_base + v. Word `corners` + c of the triangle's row holds v: a
/// vertex, or its cluster if the level is clustered (R = 1). The node i steps (1 .. R-1) from the lower
/// vertex of edge e is edge_base + e (R-1) + i-1. The interior node (i,j,k) of triangle t is interior_base +
/// t (R-1)(R-2)/2 + (i-1)(2(R-1)-i)/2 + j-1.
/// Per-triangle storage: node (i,j,k) of triangle t is vertex_base + t (R+1)(R+2)/2 + i(2R+3-i)/2 + j.
struct GateSurfaceLevel {
  uint32_t resolution = 0;
  uint32_t vertex_base = 0;
  uint32_t edge_base = 0;
  uint32_t interior_base = 0;
  uint32_t corners = 0;
};

}  // namespace gatelight::neural
