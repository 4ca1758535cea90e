#pragma once
// A plan is a layout without its tables: the resolution of each instance, the clustered levels, and the
// number of nodes. Plans are cheap, so the search for the memory budget makes many.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "neural/layout/clusters.h"
#include "neural/layout/gate_layout.h"
#include "neural/layout/mesh_topology.h"

namespace gatelight::neural {

/// The input of make_plan.
struct PlanScene {
  const SurfaceLayout& surfaces;
  const GateOptions& options;
  std::vector<std::uint32_t> stored;  ///< instances with storage
  std::vector<double> sizes;          ///< resolution_sizes() of the stored instances; 0 without area
  std::vector<MeshTopology> meshes;   ///< shared storage only; empty for meshes without a stored instance
};

PlanScene make_plan_scene(const SurfaceLayout& surfaces, const GateOptions& options);

/// The vertices of one cell that are kept separate.
enum class ClusterScope : std::uint8_t {
  instance_and_normal,  ///< vertices of different instances or normals
  instance,             ///< vertices of different instances
  scene_and_normal,     ///< vertices with different normals
};

/// The unknowns that the memory budget is solved for.
struct Density {
  float node_spacing = 0.0f;      ///< `uniform`
  float resolution_scale = 0.0f;  ///< `paper`
  ClusterScope scope = ClusterScope::instance_and_normal;
};

struct LevelPlan {
  std::uint32_t resolution = 0;
  std::uint64_t corner_nodes = 0;  ///< vertices or clusters per side; shared storage only
  bool clustered = false;
  std::uint32_t first_alike = 0;  ///< if clustered: the first level with the same clusters
};

using InstancePlan = std::array<LevelPlan, kMaxStack>;

/// With scene_and_normal: the clusters of one level, which the instances with this level clustered share.
struct SceneLevelPlan {
  std::uint64_t clusters = 0;  ///< per side
  std::uint32_t sides = 0;     ///< bit mask of the sides that have clusters
};

struct LayoutPlan {
  Density density;
  std::vector<InstancePlan> instances;  ///< in the order of PlanScene::stored
  std::array<SceneLevelPlan, kMaxStack> scene_levels = {};
  std::uint64_t node_count = 0;
};

/// Returns nullopt for more than `limit` nodes. Builds the missing parts of the scene's topologies.
std::optional<LayoutPlan> make_plan(PlanScene& scene, const Density& density, std::uint64_t limit);
/// Whether make_plan would succeed. If that is clear without clustering, `plan` stays empty; else it is set.
bool plan_fits(PlanScene& scene, const Density& density, std::uint64_t limit,
               std::optional<LayoutPlan>& plan);

bool clusters_scene(const Density& density);
/// The cluster grid of a level of the stack.
ClusterGrid cluster_grid(const PlanScene& scene, const Density& density, std::size_t level);
ClusterInstance cluster_instance(const PlanScene& scene, std::size_t stored);
std::uint32_t side_count(Sides sides);

}  // namespace gatelight::neural
