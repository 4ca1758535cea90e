#pragma once
// Clusters of vertices. The vertices of a cluster share one node: they lie in the same cell of a world-space
// grid and, with `normals`, face the same way.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "neural/layout/mesh_topology.h"
#include "neural/layout/vector3.h"

namespace gatelight::neural {

/// A cell of a grid with a divisor consists of divisor^3 cells of the grid with divisor 1. Vertices in the
/// same fine cell therefore share the coarse cell, too.
struct ClusterGrid {
  double cell = 0.0;  ///< world units, for divisor 1 and cell_scale 1
  std::uint32_t divisor = 1;
  bool normals = true;  ///< separate vertices by dominant axis and sign of their world-space normal
};

/// An instance whose vertices are clustered. With ClusterGrid::normals the topology must have normals.
struct ClusterInstance {
  const SurfaceMesh* mesh = nullptr;
  const MeshTopology* topology = nullptr;
  Transform object_to_world;
  double cell_scale = 1.0;                    ///< instances with different scales share no clusters
  std::span<const std::uint32_t> among = {};  ///< the vertices to cluster; empty means all
};

/// Counts the clusters of all vertices; vertices of different instances may share a cluster. Returns nullopt,
/// early, for more than `limit` clusters. `members` receives an arbitrary vertex of each cluster, in any
/// order.
std::optional<std::uint64_t> count_clusters(std::span<const ClusterInstance> instances,
                                            const ClusterGrid& grid, std::uint64_t limit,
                                            std::vector<std::uint32_t>* members = nullptr);

/// Returns the cluster of each vertex of each instance. Clusters are numbered in the order of their first
/// vertex. `count` is the result of count_clusters.
std::vector<std::vector<std::uint32_t>> number_clusters(std::span<const ClusterInstance> instances,
                                                        const ClusterGrid& grid, std::uint64_t count);

}  // namespace gatelight::neural
