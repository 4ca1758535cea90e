#pragma once
// Where the feature vectors of GATE lie: mesh colours (Yuksel, Keyser, House 2010) on the triangles of a
// SurfaceLayout, several resolutions deep.
//
// A *node* is one feature vector. All nodes of all levels and surfaces have one index space; node n's
// features are the floats n*L .. n*L+L-1 of the parameters. The tables here are plain arrays so that CPU
// kernels and compute shaders read the same bytes.

#include <cstdint>
#include <vector>

#include "neural/layout/gate_tables.h"
#include "neural/layout/surface_layout.h"

namespace gatelight::neural {

inline constexpr std::uint32_t kMaxResolution = 64;
inline constexpr std::uint32_t kMaxStack = 4;
/// Nodes, vertices and words of topology are counted in 32 bits.
inline constexpr std::uint64_t kMaxIndex = 0xffffffffu;

enum class ResolutionRule : std::uint8_t {
  uniform,  ///< R = round(sqrt(A) / spacing), A the area-weighted mean area of the instance's triangles,
            ///< but at most 16 times their mean (world)
  paper,    ///< R = clamp(32 A^2 scale, 1, 32), A the mean area over the greatest mean area of all instances
  fixed,    ///< the same R everywhere
};

enum class NodeStorage : std::uint8_t {
  shared,        ///< blocks [vertex | edge | interior] for each surface; edges and vertices are shared
  per_triangle,  ///< (R+1)(R+2)/2 nodes for each triangle, in a row
};

/// A level of the stack: `kAdaptive` takes the rule's R, adaptive_part(d) a d-th of it (rounded, at least 1),
/// any other value is the R of all instances.
inline constexpr std::uint32_t kAdaptive = 0;
inline constexpr std::uint32_t kMaxAdaptiveDivisor = 64;
constexpr std::uint32_t adaptive_part(std::uint32_t divisor) {
  return divisor <= 1 ? kAdaptive : divisor << 16;
}
constexpr bool is_adaptive(std::uint32_t level) {
  return (level & 0xffffu) == 0;
}
constexpr std::uint32_t adaptive_divisor(std::uint32_t level) {
  return level < 0x10000u ? 1 : level >> 16;
}

struct GateOptions {
  std::uint32_t features = 8;                         ///< L: floats in a feature vector, 1 to 16
  std::vector<std::uint32_t> stack = {kAdaptive, 1};  ///< at most kMaxStack levels
  ResolutionRule rule = ResolutionRule::uniform;
  float node_spacing = 0.1f;           ///< world units; `uniform`
  float resolution_scale = 1.0f;       ///< `paper`
  std::uint32_t fixed_resolution = 4;  ///< `fixed`
  std::uint32_t max_resolution = 32;   ///< of adaptive levels
  NodeStorage storage = NodeStorage::shared;
  /// Merge vertices in the levels of an instance that have R = 1, where triangles are smaller than the
  /// level's nodes are to be apart. A vertex's cluster is (instance, cell, dominant axis and sign of its
  /// normal); a cell is half the node spacing long, adaptive_part(d)'s d times as much. So an instance finer
  /// than the spacing has fewer nodes in coarser levels. Levels whose cells merge no vertices keep them. Only
  /// with `uniform` and `shared`.
  bool cluster = true;
  /// Bytes that the feature vectors may take, 0 for no limit. Given, node_spacing (or resolution_scale) is
  /// solved for: the finest layout that fits. Where clusters are made and even one cell for each instance and
  /// normal is too much, they lose first the normal; then those of different instances are merged, by cell
  /// and normal. A budget that cannot be met throws BadConfiguration with the least bytes possible.
  std::uint64_t memory_budget = 0;
  /// The budget is only a cap: node_spacing (or resolution_scale) is used as it is where it fits and solved
  /// for where it does not. Where nothing fits it is used all the same.
  bool budget_is_cap = false;
  std::uint32_t bytes_per_feature = 4;  ///< for the budget: 4 or 2
};

/// Words of zeros behind the topology, so that kernels may read a triangle's words four at a time.
inline constexpr std::uint32_t kTopologyPadding = 4;

struct GateLayoutReport {
  std::uint64_t vertex_nodes = 0, edge_nodes = 0, interior_nodes = 0, cluster_nodes = 0, triangle_nodes = 0;
  std::uint64_t topology_bytes = 0;
  std::uint64_t table_bytes = 0;  ///< surfaces and levels
  std::uint64_t clustered_surfaces = 0;
  std::vector<std::uint64_t> resolution_histogram;  ///< instances with storage by the R of the first level
  float node_spacing = 0.0f;                        ///< resolved: after the budget
  float resolution_scale = 0.0f;
};

struct GateLayout {
  std::uint32_t features = 0;
  std::uint32_t stack = 0;
  NodeStorage storage = NodeStorage::shared;
  std::uint32_t node_count = 0;
  std::uint32_t triangle_count = 0;   ///< with storage, each side counted
  std::vector<GateSurface> surfaces;  ///< 2 per instance
  std::vector<GateSurfaceLevel> levels;
  std::vector<std::uint32_t> topology;
  GateLayoutReport report;
};

}  // namespace gatelight::neural
