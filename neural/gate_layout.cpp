#include "neural/gate_layout.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "neural/errors.h"
#include "neural/layout/budget.h"
#include "neural/layout/layout_checks.h"
#include "neural/layout/plan.h"
#include "neural/mesh_colors.h"

namespace gatelight::neural {

namespace {

constexpr std::uint64_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();
using Range = tbb::blocked_range<std::size_t>;

/// Takes `size` numbers from 0 on, each once.
class Allocator {
 public:
  explicit Allocator(const char* what) : what_(what) {}
  std::uint32_t take(std::uint64_t size) {
    const std::uint64_t first = used_;
    used_ += size;
    if (used_ > kMaxIndex)
      throw BadConfiguration(fmt::format("{}: {} or more, expected at most {}", what_, used_, kMaxIndex));
    return static_cast<std::uint32_t>(first);
  }
  std::uint32_t used() const { return static_cast<std::uint32_t>(used_); }

 private:
  const char* what_;
  std::uint64_t used_ = 0;
};

bool has_side(const SurfaceInstance& instance, std::uint32_t side) {
  return (static_cast<std::uint32_t>(instance.sides) >> side & 1u) != 0;
}

/// A table of the topology: of a clustered instance, or else of a mesh, which its instances share.
struct TopologyTable {
  std::uint32_t offset = 0;
  std::uint32_t stride = 3;
  std::uint32_t mesh = 0;
  std::optional<std::size_t> clustered;  ///< index among the stored instances
};

struct TopologyTables {
  std::vector<TopologyTable> tables;
  std::vector<std::size_t> of_stored;  ///< each stored instance's table
  std::uint32_t words = 0;
};

TopologyTables place_tables(const PlanScene& scene, const LayoutPlan& plan) {
  TopologyTables result;
  const std::size_t count = scene.stored.size();
  std::vector<std::uint32_t> strides(scene.surfaces.meshes.size(), 3);
  const auto mesh_of = [&](std::size_t s) { return scene.surfaces.instances[scene.stored[s]].mesh; };
  for (std::size_t s = 0; s < count; ++s)
    if (std::ranges::max(plan.instances[s].resolutions) > 1) strides[mesh_of(s)] = 6;
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> of_mesh(scene.surfaces.meshes.size(), kNone);
  Allocator words("topology words");
  for (std::size_t s = 0; s < count; ++s) {
    const std::uint32_t mesh = mesh_of(s);
    const bool clustered = plan.instances[s].clustered;
    std::size_t table = clustered ? kNone : of_mesh[mesh];
    if (table == kNone) {
      table = result.tables.size();
      const std::uint32_t stride = clustered ? 3 : strides[mesh];
      const std::uint32_t offset = words.take(stride * scene.surfaces.meshes[mesh].triangles.size());
      result.tables.push_back({offset, stride, mesh, clustered ? std::optional(s) : std::nullopt});
      if (!clustered) of_mesh[mesh] = table;
    }
    result.of_stored.push_back(table);
  }
  result.words = words.used();
  return result;
}

void write_table(const TopologyTable& table, const MeshTopology& mesh,
                 const std::vector<std::uint32_t>* vertex_numbers, std::uint32_t* topology) {
  tbb::parallel_for(Range(0, mesh.triangles.size(), 16384), [&](const Range& range) {
    for (std::size_t t = range.begin(); t != range.end(); ++t) {
      std::uint32_t* words = topology + table.offset + t * table.stride;
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t vertex = mesh.triangles[t][c];
        words[c] = vertex_numbers == nullptr ? vertex : (*vertex_numbers)[vertex];
        if (table.stride == 6) words[3 + c] = mesh.triangle_edges[t][c];
      }
    }
  });
}

void write_topology(const PlanScene& scene, const LayoutPlan& plan, const TopologyTables& tables,
                    std::vector<std::uint32_t>& topology) {
  topology.resize(tables.words == 0 ? 0 : std::size_t{tables.words} + kTopologyPadding, 0);
  const ClusterGrid grid = cluster_grid(plan.density);
  std::optional<ClusterTable> scene_numbers;
  if (plan.scene_clusters > 0) {
    std::vector<ClusterInstance> instances;
    for (std::size_t s = 0; s < plan.instances.size(); ++s)
      if (plan.instances[s].clustered) instances.push_back(cluster_instance(scene, s));
    scene_numbers = number_clusters(instances, grid, plan.scene_clusters);
  }
  tbb::parallel_for(std::size_t{0}, tables.tables.size(), [&](std::size_t i) {
    const TopologyTable& table = tables.tables[i];
    const MeshTopology& mesh = scene.meshes[table.mesh];
    if (!table.clustered) return write_table(table, mesh, nullptr, topology.data());
    const ClusterInstance instance = cluster_instance(scene, *table.clustered);
    std::vector<std::uint32_t> numbers;
    if (scene_numbers) {
      numbers = vertex_clusters(instance, grid, *scene_numbers);
    } else {
      const std::uint64_t count = plan.instances[*table.clustered].vertex_nodes;
      numbers = vertex_clusters(instance, grid, number_clusters({&instance, 1}, grid, count));
    }
    write_table(table, mesh, &numbers, topology.data());
  });
}

/// The nodes of one level of one side.
GateSurfaceLevel place_nodes(const PlanScene& scene, std::size_t stored, const InstancePlan& plan,
                             std::uint32_t resolution, Allocator& nodes, GateLayoutReport& report) {
  const std::uint32_t mesh = scene.surfaces.instances[scene.stored[stored]].mesh;
  const std::uint64_t triangles = scene.surfaces.meshes[mesh].triangles.size();
  GateSurfaceLevel level;
  level.resolution = resolution;
  if (scene.options.storage == NodeStorage::per_triangle) {
    const std::uint64_t count = triangles * nodes_per_triangle(resolution);
    report.triangle_nodes += count;
    level.vertex_base = nodes.take(count);
    return level;
  }
  const std::uint64_t edge_nodes =
      plan.clustered ? 0 : std::uint64_t{scene.meshes[mesh].edge_count} * nodes_per_edge(resolution);
  const std::uint64_t interior_nodes = triangles * nodes_per_interior(resolution);
  (plan.clustered ? report.cluster_nodes : report.vertex_nodes) += plan.vertex_nodes;
  report.edge_nodes += edge_nodes;
  report.interior_nodes += interior_nodes;
  level.vertex_base = nodes.take(plan.vertex_nodes);
  level.edge_base = nodes.take(edge_nodes);
  level.interior_base = nodes.take(interior_nodes);
  return level;
}

/// One block of nodes for each side and level, which all clustered instances share.
std::vector<GateSurfaceLevel> place_scene_clusters(const PlanScene& scene, const LayoutPlan& plan,
                                                   Allocator& nodes, GateLayoutReport& report) {
  std::vector<GateSurfaceLevel> blocks(2 * scene.options.stack.size());
  for (std::uint32_t side = 0; side < 2; ++side)
    for (std::size_t l = 0; l < scene.options.stack.size(); ++l) {
      if ((plan.scene_sides >> side & 1u) == 0) continue;
      const std::uint32_t base = nodes.take(plan.scene_clusters);
      blocks[side * scene.options.stack.size() + l] = {1, base, nodes.used(), nodes.used()};
      report.cluster_nodes += plan.scene_clusters;
    }
  return blocks;
}

void place_surfaces(const PlanScene& scene, const LayoutPlan& plan, const TopologyTables* tables,
                    GateLayout& layout) {
  Allocator nodes("nodes");
  Allocator triangles("triangles with storage");
  const std::size_t stack = layout.stack;
  layout.surfaces.resize(2 * scene.surfaces.instances.size());
  layout.levels.resize(layout.surfaces.size() * stack);
  const bool merged = clusters_scene(plan.density);
  std::vector<GateSurfaceLevel> scene_blocks;
  if (merged) scene_blocks = place_scene_clusters(scene, plan, nodes, layout.report);
  for (std::size_t s = 0; s < scene.stored.size(); ++s) {
    const SurfaceInstance& instance = scene.surfaces.instances[scene.stored[s]];
    const InstancePlan& instance_plan = plan.instances[s];
    const std::uint64_t triangle_count = scene.surfaces.meshes[instance.mesh].triangles.size();
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (!has_side(instance, side)) continue;
      const std::uint32_t surface = surface_index(scene.stored[s], side);
      GateSurface& entry = layout.surfaces[surface];
      if (tables != nullptr) {
        const TopologyTable& table = tables->tables[tables->of_stored[s]];
        entry.topology_offset = table.offset;
        entry.topology_stride = table.stride;
      }
      entry.triangle_count = static_cast<std::uint32_t>(triangle_count);
      entry.first_triangle = triangles.take(triangle_count);
      for (std::size_t l = 0; l < stack; ++l)
        layout.levels[surface * stack + l] =
            merged && instance_plan.clustered
                ? scene_blocks[side * stack + l]
                : place_nodes(scene, s, instance_plan, instance_plan.resolutions[l], nodes, layout.report);
      if (instance_plan.clustered) ++layout.report.clustered_surfaces;
    }
    if (instance.sides != Sides::both) {
      const std::size_t own = surface_index(scene.stored[s], has_side(instance, 0) ? 0 : 1);
      const std::size_t other = own ^ 1u;
      layout.surfaces[other] = layout.surfaces[own];
      std::copy_n(layout.levels.begin() + own * stack, stack, layout.levels.begin() + other * stack);
    }
    ++layout.report.resolution_histogram[instance_plan.resolutions[0]];
  }
  layout.node_count = nodes.used();
  layout.triangle_count = triangles.used();
}

}  // namespace

GateLayout build_gate_layout(const SurfaceLayout& surfaces, const GateOptions& options) {
  check_gate_options(options);
  check_surfaces(surfaces);
  PlanScene scene = make_plan_scene(surfaces, options);
  const LayoutPlan plan = solve_plan(scene);

  GateLayout layout;
  layout.features = options.features;
  layout.stack = static_cast<std::uint32_t>(options.stack.size());
  layout.storage = options.storage;
  layout.report.node_spacing = plan.density.node_spacing;
  layout.report.resolution_scale = plan.density.resolution_scale;
  layout.report.resolution_histogram.assign(kMaxResolution + 1, 0);
  if (options.storage == NodeStorage::shared) {
    const TopologyTables tables = place_tables(scene, plan);
    place_surfaces(scene, plan, &tables, layout);
    write_topology(scene, plan, tables, layout.topology);
  } else {
    place_surfaces(scene, plan, nullptr, layout);
  }
  layout.report.topology_bytes = layout.topology.size() * sizeof(std::uint32_t);
  layout.report.table_bytes =
      layout.surfaces.size() * sizeof(GateSurface) + layout.levels.size() * sizeof(GateSurfaceLevel);
  return layout;
}

}  // namespace gatelight::neural
