#include "neural/layout/build_gate_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "base/errors.h"
#include "base/parallel/loops.h"
#include "neural/layout/budget.h"
#include "neural/layout/layout_checks.h"
#include "neural/layout/mesh_colors.h"
#include "neural/layout/plan.h"

namespace gatelight::neural {

namespace {

/// Hands out consecutive blocks of indices, starting at 0.
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

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool has_clusters(const InstancePlan& plan) {
  return std::ranges::any_of(plan, &LevelPlan::clustered);
}

/// A topology table. An instance with a clustered level has its own; all others share the table of their
/// mesh. A row consists of groups of three words.
struct TopologyTable {
  std::uint32_t offset = 0;
  std::uint32_t mesh = 0;
  bool vertices = false;
  bool edges = false;
  std::size_t stored = kNone;          ///< the instance whose clusters the table holds
  std::vector<std::size_t> clustered;  ///< levels whose clusters the table holds, in row order

  std::uint32_t first_clusters() const { return (vertices ? 3u : 0u) + (edges ? 3u : 0u); }
  std::uint32_t stride() const { return first_clusters() + 3 * static_cast<std::uint32_t>(clustered.size()); }
  /// The first word of a level's corners in the row.
  std::uint32_t corners(const LevelPlan& level) const {
    if (!level.clustered) return 0;
    const auto place = std::ranges::find(clustered, level.first_alike) - clustered.begin();
    return first_clusters() + 3 * static_cast<std::uint32_t>(place);
  }
};

struct TopologyTables {
  std::vector<TopologyTable> tables;
  std::vector<std::size_t> of_stored;  ///< table index of each stored instance
  std::uint32_t words = 0;
};

TopologyTables place_tables(const PlanScene& scene, const LayoutPlan& plan) {
  TopologyTables result;
  std::vector<std::size_t> of_mesh(scene.surfaces.meshes.size(), kNone);
  for (std::size_t s = 0; s < scene.stored.size(); ++s) {
    const std::uint32_t mesh = scene.surfaces.instances[scene.stored[s]].mesh;
    const bool own = has_clusters(plan.instances[s]);
    std::size_t table = own ? kNone : of_mesh[mesh];
    if (table == kNone) {
      table = result.tables.size();
      result.tables.push_back({.mesh = mesh, .stored = own ? s : kNone});
      if (!own) of_mesh[mesh] = table;
    }
    result.of_stored.push_back(table);
    TopologyTable& t = result.tables[table];
    for (std::size_t l = 0; l < scene.options.stack.size(); ++l) {
      const LevelPlan& level = plan.instances[s][l];
      t.vertices |= !level.clustered;
      t.edges |= level.resolution > 1;
      if (level.clustered && level.first_alike == l) t.clustered.push_back(l);
    }
  }
  Allocator words("topology words");
  for (TopologyTable& table : result.tables)
    table.offset = words.take(table.stride() * scene.surfaces.meshes[table.mesh].triangles.size());
  result.words = words.used();
  return result;
}

/// Three words of a row: a triangle's vertices or edges, mapped through `numbers` unless that is empty.
struct RowPart {
  std::uint32_t first = 0;
  const TriangleCorners* corners = nullptr;
  std::vector<std::uint32_t> numbers;
};

void write_rows(const TopologyTable& table, std::size_t triangles, std::span<const RowPart> parts,
                std::uint32_t* topology) {
  const std::uint32_t stride = table.stride();
  for_each_range(triangles, 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t != end; ++t) {
      std::uint32_t* const row = topology + table.offset + t * stride;
      for (const RowPart& part : parts)
        for (std::uint32_t c = 0; c < 3; ++c) {
          const std::uint32_t word = part.corners[t][c];
          row[part.first + c] = part.numbers.empty() ? word : part.numbers[word];
        }
    }
  });
}

/// With clusters over the whole scene: the cluster of each vertex, by level and stored instance.
using SceneNumbers = std::array<std::vector<std::vector<std::uint32_t>>, kMaxStack>;

SceneNumbers number_scene(const PlanScene& scene, const LayoutPlan& plan) {
  SceneNumbers numbers;
  for (std::uint32_t l = 0; l < kMaxStack; ++l) {
    std::vector<ClusterInstance> instances;
    std::vector<std::size_t> stored;
    for (std::size_t s = 0; s < plan.instances.size(); ++s) {
      const LevelPlan& level = plan.instances[s][l];
      if (!level.clustered || level.first_alike != l) continue;
      instances.push_back(cluster_instance(scene, s));
      stored.push_back(s);
    }
    if (instances.empty()) continue;
    auto of_instances =
        number_clusters(instances, cluster_grid(scene, plan.density, l), plan.scene_levels[l].clusters);
    numbers[l].resize(plan.instances.size());
    for (std::size_t i = 0; i < stored.size(); ++i) numbers[l][stored[i]] = std::move(of_instances[i]);
  }
  return numbers;
}

/// Fills in the cluster numbers of an instance; the last elements of `parts` belong to its clustered levels.
void number_instance(const PlanScene& scene, const LayoutPlan& plan, const TopologyTable& table,
                     std::span<RowPart> parts) {
  parts = parts.last(table.clustered.size());
  ClusterInstance instance = cluster_instance(scene, table.stored);
  const auto number = [&](std::size_t i) {
    const std::size_t l = table.clustered[i];
    return std::move(number_clusters({&instance, 1}, cluster_grid(scene, plan.density, l),
                                     plan.instances[table.stored][l].corner_nodes)[0]);
  };
  const auto divisor = [&](std::size_t l) { return adaptive_divisor(scene.options.stack[l]); };
  const std::size_t finest =
      static_cast<std::size_t>(std::ranges::find(table.clustered, 1u, divisor) - table.clustered.begin());
  std::vector<std::uint32_t> first_vertices;  // of the finest clusters, from which coarser ones are made
  if (finest < parts.size()) {
    parts[finest].numbers = number(finest);
    for (std::uint32_t v = 0; v < parts[finest].numbers.size(); ++v)
      if (parts[finest].numbers[v] == first_vertices.size()) first_vertices.push_back(v);
    instance.among = first_vertices;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == finest) continue;
    parts[i].numbers = number(i);
    if (finest == parts.size()) continue;
    std::vector<std::uint32_t> of_vertices(parts[finest].numbers.size());
    for_each_range(of_vertices.size(), 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v != end; ++v) of_vertices[v] = parts[i].numbers[parts[finest].numbers[v]];
    });
    parts[i].numbers = std::move(of_vertices);
  }
}

void write_topology(const PlanScene& scene, const LayoutPlan& plan, const TopologyTables& tables,
                    HugeBuffer<std::uint32_t>& topology) {
  if (tables.words > 0) topology = HugeBuffer<std::uint32_t>(std::size_t{tables.words} + kTopologyPadding);
  const bool merged = clusters_scene(plan.density);
  SceneNumbers scene_numbers;
  if (merged) scene_numbers = number_scene(scene, plan);
  for_each(tables.tables.size(), [&](std::size_t i) {
    const TopologyTable& table = tables.tables[i];
    const MeshTopology& mesh = scene.meshes[table.mesh];
    std::vector<RowPart> parts;
    if (table.vertices) parts.push_back({0, mesh.triangles.data(), {}});
    if (table.edges) parts.push_back({kTopologyEdges, mesh.triangle_edges.data(), {}});
    for (const std::size_t l : table.clustered) {
      const std::uint32_t first = table.corners(plan.instances[table.stored][l]);
      parts.push_back({first, mesh.triangles.data(),
                       merged ? std::move(scene_numbers[l][table.stored]) : std::vector<std::uint32_t>()});
    }
    if (!merged && !table.clustered.empty()) number_instance(scene, plan, table, parts);
    write_rows(table, mesh.triangles.size(), parts, topology.data());
  });
}

/// Allocates the nodes of one level of one side.
GateSurfaceLevel place_nodes(const PlanScene& scene, std::size_t stored, const LevelPlan& plan,
                             Allocator& nodes, GateLayoutReport& report) {
  const std::uint32_t mesh = scene.surfaces.instances[scene.stored[stored]].mesh;
  const std::uint64_t triangles = scene.surfaces.meshes[mesh].triangles.size();
  GateSurfaceLevel level;
  level.resolution = plan.resolution;
  if (scene.options.storage == NodeStorage::per_triangle) {
    const std::uint64_t count = triangles * nodes_per_triangle(plan.resolution);
    report.triangle_nodes += count;
    level.vertex_base = nodes.take(count);
    return level;
  }
  const std::uint64_t edge_nodes =
      std::uint64_t{scene.meshes[mesh].edge_count} * nodes_per_edge(plan.resolution);
  const std::uint64_t interior_nodes = triangles * nodes_per_interior(plan.resolution);
  (plan.clustered ? report.cluster_nodes : report.vertex_nodes) += plan.corner_nodes;
  report.edge_nodes += edge_nodes;
  report.interior_nodes += interior_nodes;
  level.vertex_base = nodes.take(plan.corner_nodes);
  level.edge_base = nodes.take(edge_nodes);
  level.interior_base = nodes.take(interior_nodes);
  return level;
}

/// For each side and level, the nodes that all instances with this level clustered share.
using SceneBlocks = std::array<std::array<GateSurfaceLevel, kMaxStack>, 2>;

SceneBlocks place_scene_clusters(const LayoutPlan& plan, Allocator& nodes, GateLayoutReport& report) {
  SceneBlocks blocks = {};
  for (std::uint32_t side = 0; side < 2; ++side)
    for (std::size_t l = 0; l < kMaxStack; ++l) {
      const SceneLevelPlan& level = plan.scene_levels[l];
      if ((level.sides >> side & 1u) == 0) continue;
      const std::uint32_t base = nodes.take(level.clusters);
      blocks[side][l] = {1, base, nodes.used(), nodes.used()};
      report.cluster_nodes += level.clusters;
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
  const SceneBlocks scene_blocks = place_scene_clusters(plan, nodes, layout.report);
  for (std::size_t s = 0; s < scene.stored.size(); ++s) {
    const SurfaceInstance& instance = scene.surfaces.instances[scene.stored[s]];
    const InstancePlan& instance_plan = plan.instances[s];
    const TopologyTable* table = tables == nullptr ? nullptr : &tables->tables[tables->of_stored[s]];
    const std::uint64_t triangle_count = scene.surfaces.meshes[instance.mesh].triangles.size();
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (!has_side(instance, side)) continue;
      const std::uint32_t surface = surface_index(scene.stored[s], side);
      GateSurface& entry = layout.surfaces[surface];
      if (table != nullptr) {
        entry.topology_offset = table->offset;
        entry.topology_stride = table->stride();
      }
      entry.triangle_count = static_cast<std::uint32_t>(triangle_count);
      entry.first_triangle = triangles.take(triangle_count);
      for (std::size_t l = 0; l < stack; ++l) {
        const LevelPlan& level = instance_plan[l];
        GateSurfaceLevel& placed = layout.levels[surface * stack + l];
        placed = merged && level.clustered ? scene_blocks[side][l]
                                           : place_nodes(scene, s, level, nodes, layout.report);
        if (table != nullptr) placed.corners = table->corners(level);
      }
      if (has_clusters(instance_plan)) ++layout.report.clustered_surfaces;
    }
    if (instance.sides != Sides::both) {
      const std::size_t own = surface_index(scene.stored[s], has_side(instance, 0) ? 0 : 1);
      const std::size_t other = own ^ 1u;
      layout.surfaces[other] = layout.surfaces[own];
      std::copy_n(layout.levels.begin() + own * stack, stack, layout.levels.begin() + other * stack);
    }
    ++layout.report.resolution_histogram[instance_plan[0].resolution];
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
