#pragma once
// The layout of GATE's feature vectors: mesh colours (Yuksel, Keyser, House 2010) on the triangles of a
// SurfaceLayout, in several resolutions.
//
// A *node* is one feature vector. The nodes of all levels and surfaces have one index space. The features of
// node n are the floats n*L .. n*L+L-1 of the parameters. CPU kernels and compute shaders read the same
// tables.

#include <cstdint>
#include <string>
#include <vector>

#include "base/platform/huge_buffer.h"
#include "neural/layout/gate_tables.h"
#include "neural/layout/surface_layout.h"

namespace gatelight::neural {

inline constexpr std::uint32_t kMaxResolution = 64;
inline constexpr std::uint32_t kMaxStack = 4;
/// Nodes, vertices and words of topology have 32-bit indices.
inline constexpr std::uint64_t kMaxIndex = 0xffffffffu;

enum class ResolutionRule : std::uint8_t {
  uniform,  ///< R = round(sqrt(A) / spacing); A is the area-weighted mean area of the instance's triangles in
            ///< world space, at most 16 times their mean
  paper,    ///< R = clamp(32 A^2 scale, 1, 32); A is the instance's mean area over the greatest of all
            ///< instances
  fixed,    ///< the same R for all instances
};

enum class NodeStorage : std::uint8_t {
  shared,        ///< blocks [vertex | edge | interior] for each surface; edges and vertices are shared
  per_triangle,  ///< (R+1)(R+2)/2 consecutive nodes for each triangle
};

/// A level of the stack is kAdaptive (the rule's R), adaptive_part(d) (a d-th of it, rounded, at least 1), or
/// the R of all instances.
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

/// The name of a level: "adaptive", "adaptive/4" or "1".
std::string level_text(std::uint32_t level);
/// "adaptive,adaptive/4,1"
std::string stack_text(const std::vector<std::uint32_t>& stack);

struct GateOptions {
  std::uint32_t features = 8;                         ///< L: floats in a feature vector, 1 to 16
  std::vector<std::uint32_t> stack = {kAdaptive, 1};  ///< at most kMaxStack levels
  ResolutionRule rule = ResolutionRule::uniform;
  float node_spacing = 0.1f;           ///< world units; `uniform`
  float resolution_scale = 1.0f;       ///< `paper`
  std::uint32_t fixed_resolution = 4;  ///< `fixed`
  std::uint32_t max_resolution = 32;   ///< of adaptive levels
  NodeStorage storage = NodeStorage::shared;
  /// Merge vertices in levels with R = 1, where triangles may be smaller than the level's node spacing. A
  /// cluster is (instance, cell, dominant axis and sign of the normal). A cell is half the node spacing long,
  /// d times that with adaptive_part(d), so instances finer than the spacing have fewer nodes in coarser
  /// levels. A level whose cells merge no vertices is not clustered. Used only with `uniform` and `shared`.
  bool cluster = true;
  /// Maximum bytes of the feature vectors; 0 means no limit. With a limit, node_spacing (or resolution_scale)
  /// is solved for the finest layout that fits. If even one cell per instance and normal is too much,
  /// clusters first ignore normals; then clusters of different instances merge, by cell and normal. If
  /// nothing fits, BadConfiguration is thrown and names the smallest possible budget.
  std::uint64_t memory_budget = 0;
  /// The budget is only a cap: the given node_spacing (or resolution_scale) is used if it fits and solved for
  /// if not. If nothing fits, the given value is used and the budget is exceeded.
  bool budget_is_cap = false;
  std::uint32_t bytes_per_feature = 4;  ///< 4 or 2, for the budget
};

/// Zero words behind the topology, so that kernels may load a triangle's words four at a time.
inline constexpr std::uint32_t kTopologyPadding = 4;

struct GateLayoutReport {
  std::uint64_t vertex_nodes = 0, edge_nodes = 0, interior_nodes = 0, cluster_nodes = 0, triangle_nodes = 0;
  std::uint64_t topology_bytes = 0;
  std::uint64_t table_bytes = 0;  ///< surfaces and levels
  std::uint64_t clustered_surfaces = 0;
  std::vector<std::uint64_t> resolution_histogram;  ///< stored instances, by R of their first level
  float node_spacing = 0.0f;                        ///< the value used, after the budget
  float resolution_scale = 0.0f;
};

struct GateLayout {
  std::uint32_t features = 0;
  std::uint32_t stack = 0;
  NodeStorage storage = NodeStorage::shared;
  std::uint32_t node_count = 0;
  std::uint32_t triangle_count = 0;   ///< triangles with storage, counted once per side
  std::vector<GateSurface> surfaces;  ///< 2 per instance
  std::vector<GateSurfaceLevel> levels;
  HugeBuffer<std::uint32_t> topology;
  GateLayoutReport report;
};

}  // namespace gatelight::neural
