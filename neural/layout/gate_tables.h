#pragma once
// The tables that lead from a point on a surface to its nodes: plain words, read by CPU kernels and compute
// shaders.

#include <stdint.h>

namespace gatelight::neural {

/// The topology of surface s: triangle t's row of words is topology[topology_offset + t * topology_stride]
/// and on. A row is made of threes, a word for each corner: the triangle's vertices, where a level of the
/// surface has them for its corners; then its edges, where a level has R > 1, edge c being the one opposite
/// to corner c; then, for each cell size that a level is clustered with, the clusters of its vertices.
/// Surfaces without a clustered level share the table of their mesh, which has edges where one of them needs
/// them. All these numbers count from the bases of the level. An edge is walked from its vertex with the
/// lower number to the one with the higher; one between equal vertices, of a degenerate triangle, from corner
/// c+2 to c+1 (modulo 3). Per triangle: no topology.
struct GateSurface {
  uint32_t topology_offset = 0;
  uint32_t topology_stride = 3;  ///< a multiple of 3
  uint32_t triangle_count = 0;
  uint32_t first_triangle = 0;  ///< number of the surface's triangle 0 among all triangles with storage
};

/// Where the edges lie in the rows of surfaces that have a level with R > 1; such levels have vertices for
/// corners, which lie at 0.
constexpr uint32_t kTopologyEdges = 3;

/// One level of one surface, at levels[surface * stack + level]. R = 0: no storage.
/// Shared: corner c's node is vertex_base + v, v being word `corners` + c of the triangle's row: a vertex, or
/// the vertex's cluster where the level is clustered (R = 1). The node i steps (1 .. R-1) from the lower
/// vertex of edge e is edge_base + e (R-1) + i-1; the interior node (i,j,k) of triangle t is
/// interior_base + t (R-1)(R-2)/2 + (i-1)(2(R-1)-i)/2 + j-1.
/// Per triangle: node (i,j,k) of triangle t is vertex_base + t (R+1)(R+2)/2 + i(2R+3-i)/2 + j.
/// (i,j,k) are the integer barycentrics that belong to corners 0, 1, 2; their sum is R.
struct GateSurfaceLevel {
  uint32_t resolution = 0;
  uint32_t vertex_base = 0;
  uint32_t edge_base = 0;
  uint32_t interior_base = 0;
  uint32_t corners = 0;
};

}  // namespace gatelight::neural
