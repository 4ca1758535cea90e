#pragma once
// Clusters: vertices that share one node because they lie in one cell of a world-space grid and, where
// normals count, face the same way.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "neural/layout/cluster_table.h"
#include "neural/layout/mesh_topology.h"
#include "neural/layout/vector3.h"

namespace gatelight::neural {

struct ClusterGrid {
  double cell = 0.0;    ///< world units, where an instance's scale is 1
  bool normals = true;  ///< keep apart by dominant axis and sign of the vertex's world-space normal
};

/// An instance whose vertices are clustered. With `normals` the topology must have them.
struct ClusterInstance {
  const SurfaceMesh* mesh = nullptr;
  const MeshTopology* topology = nullptr;
  Transform object_to_world;
  double cell_scale = 1.0;  ///< cells of instances with different scales have no vertices in common
};

/// The clusters of the instances' vertices, vertices of different instances merged too. Nothing where they
/// are more than `limit` (found early).
std::optional<std::uint64_t> count_clusters(std::span<const ClusterInstance> instances,
                                            const ClusterGrid& grid, std::uint64_t limit);

/// The clusters' numbers, in the order of their first vertex; `count` is what count_clusters gave.
ClusterTable number_clusters(std::span<const ClusterInstance> instances, const ClusterGrid& grid,
                             std::uint64_t count);

/// For each vertex of one of the instances the number of its cluster.
std::vector<std::uint32_t> vertex_clusters(const ClusterInstance& instance, const ClusterGrid& grid,
                                           const ClusterTable& numbers);

}  // namespace gatelight::neural
