#pragma once
// Clusters: vertices that share one node because they lie in one cell of a world-space grid and, where
// normals count, face the same way.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "neural/layout/mesh_topology.h"
#include "neural/layout/vector3.h"

namespace gatelight::neural {

/// The cells of a grid with a divisor are made of divisor^3 cells of the one without: what is in one cell of
/// the finer grid is in one of the coarser.
struct ClusterGrid {
  double cell = 0.0;  ///< of divisor 1, in world units, where an instance's scale is 1
  std::uint32_t divisor = 1;
  bool normals = true;  ///< keep apart by dominant axis and sign of the vertex's world-space normal
};

/// An instance whose vertices are clustered. With `normals` the topology must have them.
struct ClusterInstance {
  const SurfaceMesh* mesh = nullptr;
  const MeshTopology* topology = nullptr;
  Transform object_to_world;
  double cell_scale = 1.0;  ///< cells of instances with different scales have no vertices in common
  std::span<const std::uint32_t> among = {};  ///< the vertices to cluster; empty: all of the topology
};

/// The clusters of the instances' vertices, vertices of different instances merged too. Nothing where they
/// are more than `limit` (found early). `members` gets the number of one vertex of each cluster, any one, in
/// any order.
std::optional<std::uint64_t> count_clusters(std::span<const ClusterInstance> instances,
                                            const ClusterGrid& grid, std::uint64_t limit,
                                            std::vector<std::uint32_t>* members = nullptr);

/// For each vertex of each instance the number of its cluster; clusters are numbered in the order of their
/// first vertex. `count` is what count_clusters gave.
std::vector<std::vector<std::uint32_t>> number_clusters(std::span<const ClusterInstance> instances,
                                                        const ClusterGrid& grid, std::uint64_t count);

}  // namespace gatelight::neural
