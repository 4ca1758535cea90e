#pragma once
// What of a mesh's topology the layout needs; made when something first needs it.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "neural/layout/surface_layout.h"
#include "neural/layout/vector3.h"
#include "neural/layout/vertex_corners.h"

namespace gatelight::neural {

/// Vertices are the positions that triangles use, numbered in the order of the positions.
struct MeshTopology {
  std::vector<std::uint32_t> vertices;     ///< their positions' indices
  std::vector<TriangleCorners> triangles;  ///< vertex numbers
  std::optional<VertexCorners> corners;
  /// Edges opposite to the corners; numbered by their lower, then their higher vertex. All triangles between
  /// two vertices share one edge; a triangle with equal corners has an edge from a vertex to itself.
  std::vector<TriangleCorners> triangle_edges;
  std::uint32_t edge_count = 0;
  std::vector<Double3> normals;  ///< of vertices: area-weighted, twice the area, object space
};

MeshTopology number_vertices(const SurfaceMesh& mesh);
/// Nothing to do where they are already there.
void add_edges(MeshTopology& topology);
void add_normals(MeshTopology& topology, const SurfaceMesh& mesh);

}  // namespace gatelight::neural
