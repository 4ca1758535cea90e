#pragma once
// The tables that lead from a point on a surface to its nodes: plain words, read by CPU kernels and compute
// shaders.

#include <stdint.h>

namespace gatelight::neural {

/// The topology of surface s: for triangle t the three corners at topology[topology_offset + t *
/// topology_stride], then, if the stride is 6, its three edges; edge c is the one opposite to corner c.
/// Corner and edge numbers count from vertex_base and edge_base. An edge is walked from its corner with the
/// lower number to the one with the higher; one between equal corners, of a degenerate triangle, from corner
/// c+2 to c+1 (modulo 3). A clustered surface has its clusters for corners. Per triangle: no topology.
struct GateSurface {
  uint32_t topology_offset = 0;
  uint32_t topology_stride = 3;  ///< 3 or 6
  uint32_t triangle_count = 0;
  uint32_t first_triangle = 0;  ///< number of the surface's triangle 0 among all triangles with storage
};

/// One level of one surface, at levels[surface * stack + level]. R = 0: no storage.
/// Shared: corner v's node is vertex_base + v; the node i steps (1 .. R-1) from the lower corner of edge e is
/// edge_base + e (R-1) + i-1; the interior node (i,j,k) of triangle t is
/// interior_base + t (R-1)(R-2)/2 + (i-1)(2(R-1)-i)/2 + j-1.
/// Per triangle: node (i,j,k) of triangle t is vertex_base + t (R+1)(R+2)/2 + i(2R+3-i)/2 + j.
/// (i,j,k) are the integer barycentrics that belong to corners 0, 1, 2; their sum is R.
struct GateSurfaceLevel {
  uint32_t resolution = 0;
  uint32_t vertex_base = 0;
  uint32_t edge_base = 0;
  uint32_t interior_base = 0;
};

}  // namespace gatelight::neural
