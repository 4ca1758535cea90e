#pragma once
// A plan is a layout without its tables: the resolution of each instance, what is clustered, and the number
// of nodes. Cheap enough that the memory budget tries many.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "neural/layout/clusters.h"
#include "neural/layout/gate_layout.h"
#include "neural/layout/mesh_topology.h"

namespace gatelight::neural {

/// What plans are made from.
struct PlanScene {
  const SurfaceLayout& surfaces;
  const GateOptions& options;
  std::vector<std::uint32_t> stored;  ///< instances with storage
  std::vector<double> sizes;          ///< of each stored instance, by rule; 0 without area
  std::vector<MeshTopology> meshes;   ///< shared storage: of the stored instances' meshes, others empty
};

PlanScene make_plan_scene(const SurfaceLayout& surfaces, const GateOptions& options);

/// Which vertices of one cell stay apart.
enum class ClusterScope : std::uint8_t {
  instance_and_normal,  ///< those of different instances or normals
  instance,             ///< those of different instances
  scene_and_normal,     ///< those of different normals
};

/// What the memory budget solves for.
struct Density {
  float node_spacing = 0.0f;      ///< `uniform`
  float resolution_scale = 0.0f;  ///< `paper`
  ClusterScope scope = ClusterScope::instance_and_normal;
};

struct LevelPlan {
  std::uint32_t resolution = 0;
  std::uint64_t corner_nodes = 0;  ///< a side, shared storage: vertices or clusters
  bool clustered = false;
  std::uint32_t first_alike = 0;  ///< clustered: the first level with the same clusters
};

using InstancePlan = std::array<LevelPlan, kMaxStack>;

/// With scene_and_normal: the clusters of one level that all instances with it clustered have together.
struct SceneLevelPlan {
  std::uint64_t clusters = 0;  ///< a side
  std::uint32_t sides = 0;     ///< mask of the sides that have them
};

struct LayoutPlan {
  Density density;
  std::vector<InstancePlan> instances;  ///< in the order of PlanScene::stored
  std::array<SceneLevelPlan, kMaxStack> scene_levels = {};
  std::uint64_t node_count = 0;
};

/// Nothing where there would be more than `limit` nodes. Adds to the scene's topologies what it needs of
/// them.
std::optional<LayoutPlan> make_plan(PlanScene& scene, const Density& density, std::uint64_t limit);
/// Whether make_plan gives a plan, at less cost where that is plain before vertices are clustered; else the
/// plan is `plan`.
bool plan_fits(PlanScene& scene, const Density& density, std::uint64_t limit,
               std::optional<LayoutPlan>& plan);

bool clusters_scene(const Density& density);
/// Of a level of the stack.
ClusterGrid cluster_grid(const PlanScene& scene, const Density& density, std::size_t level);
ClusterInstance cluster_instance(const PlanScene& scene, std::size_t stored);
std::uint32_t side_count(Sides sides);

}  // namespace gatelight::neural
