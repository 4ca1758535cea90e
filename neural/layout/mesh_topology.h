#pragma once
// The parts of a mesh's topology that the layout needs; each part is built on first use.

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
  std::vector<std::uint32_t> vertices;     ///< position indices
  std::vector<TriangleCorners> triangles;  ///< vertex numbers
  std::optional<VertexCorners> corners;
  /// Edges opposite to the corners, numbered by their lower, then their higher vertex. All triangles at a
  /// pair of vertices share its edge. A triangle with equal corners has an edge from a vertex to itself.
  std::vector<TriangleCorners> triangle_edges;
  std::uint32_t edge_count = 0;
  std::vector<Double3> normals;  ///< per vertex, object space: the sum of its triangles' area_vector()
};

MeshTopology number_vertices(const SurfaceMesh& mesh);
/// add_edges and add_normals do nothing if the part exists.
void add_edges(MeshTopology& topology);
void add_normals(MeshTopology& topology, const SurfaceMesh& mesh);

}  // namespace gatelight::neural
