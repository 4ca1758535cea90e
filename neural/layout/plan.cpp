#include "neural/layout/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/errors.h"
#include "base/parallel/loops.h"
#include "neural/layout/mesh_colors.h"
#include "neural/layout/resolution.h"
#include "neural/layout/surface_areas.h"

namespace gatelight::neural {

namespace {

const SurfaceInstance& instance_of(const PlanScene& scene, std::size_t stored) {
  return scene.surfaces.instances[scene.stored[stored]];
}

std::uint32_t mesh_of(const PlanScene& scene, std::size_t stored) {
  return instance_of(scene, stored).mesh;
}

std::span<const LevelPlan> levels(const PlanScene& scene, const InstancePlan& plan) {
  return {plan.data(), scene.options.stack.size()};
}

double node_spacing(const PlanScene& scene, const Density& density, std::size_t stored) {
  return double{density.node_spacing} * instance_of(scene, stored).spacing_scale;
}

bool has_edges(const PlanScene& scene, const InstancePlan& plan) {
  return std::ranges::any_of(levels(scene, plan), [](const LevelPlan& l) { return l.resolution > 1; });
}

/// Nodes of all sides. Edges that are not built yet count as none.
std::uint64_t count_nodes(const PlanScene& scene, std::size_t stored, const LevelPlan& level) {
  const std::uint32_t mesh = mesh_of(scene, stored);
  const std::uint64_t triangles = scene.surfaces.meshes[mesh].triangles.size();
  const std::uint64_t nodes =
      scene.options.storage == NodeStorage::per_triangle
          ? triangles * nodes_per_triangle(level.resolution)
          : level.corner_nodes +
                std::uint64_t{scene.meshes[mesh].edge_count} * nodes_per_edge(level.resolution) +
                triangles * nodes_per_interior(level.resolution);
  return nodes * side_count(instance_of(scene, stored).sides);
}

/// Levels of a stored instance that may be clustered and have the same clusters.
struct Clusterable {
  std::size_t stored = 0;
  std::uint32_t levels = 0;  ///< mask
  std::uint32_t first() const { return static_cast<std::uint32_t>(std::countr_zero(levels)); }
  bool has(std::size_t level) const { return (levels >> level & 1u) != 0; }
};

void set_clusters(const Clusterable& levels, std::uint64_t clusters, LayoutPlan& plan) {
  InstancePlan& instance = plan.instances[levels.stored];
  for (std::size_t l = 0; l < instance.size(); ++l) {
    if (!levels.has(l)) continue;
    instance[l].corner_nodes = clusters;
    instance[l].clustered = true;
    instance[l].first_alike = levels.first();
  }
}

/// Applies `add` once to each mesh of the listed instances.
template <class Add>
void add_to_meshes(PlanScene& scene, std::span<const std::size_t> stored, const Add& add) {
  std::vector<std::uint32_t> numbers;
  for (const std::size_t s : stored) numbers.push_back(mesh_of(scene, s));
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for_each(numbers.size(),
           [&](std::size_t i) { add(scene.meshes[numbers[i]], scene.surfaces.meshes[numbers[i]]); });
}

/// All groups of levels of one instance.
struct ClusterableInstance {
  std::size_t stored = 0;
  std::span<const Clusterable> groups;
};

std::vector<ClusterableInstance> by_instance(std::span<const Clusterable> clusterable) {
  std::vector<ClusterableInstance> result;
  for (std::size_t first = 0, i = 0; i < clusterable.size(); ++i)
    if (i + 1 == clusterable.size() || clusterable[i + 1].stored != clusterable[i].stored) {
      result.push_back({clusterable[i].stored, clusterable.subspan(first, i + 1 - first)});
      first = i + 1;
    }
  return result;
}

/// Clusters each instance separately. Returns false if the plan has more than `limit` nodes.
bool cluster_instances(const PlanScene& scene, std::span<const Clusterable> clusterable, std::uint64_t limit,
                       LayoutPlan& plan) {
  const std::uint64_t counted = plan.node_count;
  std::atomic<std::uint64_t> nodes = counted;
  std::atomic<bool> over = false;
  const std::vector<ClusterableInstance> instances = by_instance(clusterable);
  for_each(instances.size(), [&](std::size_t i) {
    const auto [stored, groups] = instances[i];
    const std::uint64_t sides = side_count(instance_of(scene, stored).sides);
    const std::uint64_t vertices = scene.meshes[mesh_of(scene, stored)].vertices.size();
    ClusterInstance instance = cluster_instance(scene, stored);
    std::vector<std::uint32_t> members;  // of the finest clusters, from which coarser ones are made
    for (const Clusterable& levels : groups) {
      if (over) return;
      const std::uint64_t per_cluster = sides * static_cast<std::uint64_t>(std::popcount(levels.levels));
      // Clustering is useless with as many clusters as vertices.
      const std::uint64_t most = std::min(vertices - 1, (limit - counted) / per_cluster);
      const ClusterGrid grid = cluster_grid(scene, plan.density, levels.first());
      const bool finest = grid.divisor == 1;
      const auto count = count_clusters({&instance, 1}, grid, most, finest ? &members : nullptr);
      if (count) set_clusters(levels, *count, plan);
      if (finest) instance.among = members;
      const std::uint64_t added = count.value_or(vertices) * per_cluster;
      if (nodes.fetch_add(added) + added > limit) over = true;
    }
  });
  plan.node_count = nodes;
  return !over;
}

bool cluster_scene(const PlanScene& scene, std::span<const Clusterable> clusterable, std::uint64_t limit,
                   LayoutPlan& plan) {
  for (std::size_t l = 0; l < scene.options.stack.size(); ++l) {
    SceneLevelPlan& level = plan.scene_levels[l];
    std::vector<ClusterInstance> instances;
    std::size_t first = l;
    for (const Clusterable& levels : clusterable) {
      if (!levels.has(l)) continue;
      first = levels.first();
      level.sides |= static_cast<std::uint32_t>(instance_of(scene, levels.stored).sides);
      instances.push_back(cluster_instance(scene, levels.stored));
    }
    if (instances.empty()) continue;
    const auto sides = static_cast<std::uint64_t>(std::popcount(level.sides));
    const std::uint64_t most = (limit - plan.node_count) / sides;
    const auto count = first < l ? plan.scene_levels[first].clusters
                                 : count_clusters(instances, cluster_grid(scene, plan.density, l), most);
    if (!count || *count > most) return false;
    level.clusters = *count;
    plan.node_count += *count * sides;
  }
  for (const Clusterable& levels : clusterable)
    set_clusters(levels, plan.scene_levels[levels.first() % plan.scene_levels.size()].clusters, plan);
  return true;
}

bool cluster(PlanScene& scene, std::span<const Clusterable> clusterable, std::uint64_t limit,
             LayoutPlan& plan) {
  if (plan.density.scope != ClusterScope::instance) {
    std::vector<std::size_t> stored;
    for (const Clusterable& levels : clusterable) stored.push_back(levels.stored);
    add_to_meshes(scene, stored, add_normals);
  }
  return clusters_scene(plan.density) ? cluster_scene(scene, clusterable, limit, plan)
                                      : cluster_instances(scene, clusterable, limit, plan);
}

/// Whether two levels with R = 1 have the same clusters: the cells are equal and, if instances are merged,
/// the same instances have R = 1.
bool clusters_alike(const PlanScene& scene, const LayoutPlan& plan, std::size_t a, std::size_t b) {
  const std::vector<std::uint32_t>& stack = scene.options.stack;
  if (adaptive_divisor(stack[a]) != adaptive_divisor(stack[b])) return false;
  return !clusters_scene(plan.density) || std::ranges::all_of(plan.instances, [&](const InstancePlan& i) {
    return (i[a].resolution == 1) == (i[b].resolution == 1);
  });
}

/// The levels with R = 1 of each stored instance, grouped by equal clusters, small cells first.
std::vector<Clusterable> find_clusterable(const PlanScene& scene, const LayoutPlan& plan) {
  const std::size_t stack = scene.options.stack.size();
  std::array<std::uint32_t, kMaxStack> alike = {};
  for (std::size_t a = 0; a < stack; ++a)
    for (std::size_t b = 0; b < stack; ++b)
      if (clusters_alike(scene, plan, a, b)) alike[a] |= 1u << b;
  std::vector<Clusterable> result;
  for (std::size_t s = 0; s < plan.instances.size(); ++s) {
    if (scene.meshes[mesh_of(scene, s)].vertices.empty()) continue;
    std::uint32_t left = 0;
    for (std::size_t l = 0; l < stack; ++l)
      if (plan.instances[s][l].resolution == 1) left |= 1u << l;
    const std::size_t first = result.size();
    while (left != 0) {
      const std::uint32_t levels = left & alike[static_cast<std::size_t>(std::countr_zero(left))];
      result.push_back({s, levels});
      left &= ~levels;
    }
    std::ranges::stable_sort(
        result.begin() + static_cast<std::ptrdiff_t>(first), result.end(), {},
        [&](const Clusterable& c) { return adaptive_divisor(scene.options.stack[c.first()]); });
  }
  return result;
}

/// A plan whose node count excludes the clusterable levels.
struct UnclusteredPlan {
  LayoutPlan plan;
  std::vector<Clusterable> clusterable;
};

std::optional<UnclusteredPlan> plan_unclustered(PlanScene& scene, const Density& density,
                                                std::uint64_t limit) {
  const GateOptions& options = scene.options;
  const bool shared = options.storage == NodeStorage::shared;
  const bool may_cluster = options.cluster && shared && options.rule == ResolutionRule::uniform;
  UnclusteredPlan result;
  LayoutPlan& plan = result.plan;
  plan.density = density;
  plan.instances.resize(scene.stored.size());
  std::vector<std::size_t> edged;
  for (std::size_t s = 0; s < scene.stored.size(); ++s) {
    InstancePlan& instance = plan.instances[s];
    const std::uint32_t adaptive = adaptive_resolution(
        options, scene.sizes[s], node_spacing(scene, density, s), density.resolution_scale);
    for (std::size_t l = 0; l < options.stack.size(); ++l) {
      instance[l].resolution = level_resolution(options.stack[l], adaptive);
      if (shared) instance[l].corner_nodes = scene.meshes[mesh_of(scene, s)].vertices.size();
    }
    if (has_edges(scene, instance)) edged.push_back(s);
  }
  if (may_cluster) result.clusterable = find_clusterable(scene, plan);
  const auto fits = [&] {
    plan.node_count = 0;
    for (std::size_t s = 0; s < plan.instances.size(); ++s)
      for (const LevelPlan& level : levels(scene, plan.instances[s]))
        if (!may_cluster || level.resolution != 1) plan.node_count += count_nodes(scene, s, level);
    return plan.node_count <= limit;
  };
  if (!fits()) return std::nullopt;  // before the edges are built
  if (shared) {
    add_to_meshes(scene, edged, [](MeshTopology& topology, const SurfaceMesh&) { add_edges(topology); });
    if (!fits()) return std::nullopt;
  }
  return result;
}

}  // namespace

std::uint32_t side_count(Sides sides) {
  return static_cast<std::uint32_t>(std::popcount(static_cast<std::uint8_t>(sides)));
}

bool clusters_scene(const Density& density) {
  return density.scope == ClusterScope::scene_and_normal;
}

ClusterGrid cluster_grid(const PlanScene& scene, const Density& density, std::size_t level) {
  return {0.5 * density.node_spacing, adaptive_divisor(scene.options.stack[level]),
          density.scope != ClusterScope::instance};
}

ClusterInstance cluster_instance(const PlanScene& scene, std::size_t stored) {
  const SurfaceInstance& instance = instance_of(scene, stored);
  return {&scene.surfaces.meshes[instance.mesh], &scene.meshes[instance.mesh],
          to_transform(instance.object_to_world), instance.spacing_scale};
}

PlanScene make_plan_scene(const SurfaceLayout& surfaces, const GateOptions& options) {
  PlanScene scene{surfaces, options, {}, {}, {}};
  std::vector<char> used(surfaces.meshes.size(), 0);
  for (std::size_t i = 0; i < surfaces.instances.size(); ++i) {
    if (surfaces.instances[i].sides == Sides::none) continue;
    scene.stored.push_back(static_cast<std::uint32_t>(i));
    used[surfaces.instances[i].mesh] = 1;
  }
  if (options.storage == NodeStorage::shared) {
    scene.meshes.resize(surfaces.meshes.size());
    for_each(used.size(), [&](std::size_t m) {
      if (used[m] != 0) scene.meshes[m] = number_vertices(surfaces.meshes[m]);
    });
  }
  std::vector<SurfaceAreas> areas(scene.stored.size());
  if (options.rule != ResolutionRule::fixed && std::ranges::any_of(options.stack, is_adaptive))
    for_each(areas.size(), [&](std::size_t s) {
      const SurfaceInstance& instance = instance_of(scene, s);
      areas[s] = measure_areas(surfaces.meshes[instance.mesh], to_transform(instance.object_to_world));
    });
  for (std::size_t s = 0; s < areas.size(); ++s)
    if (!std::isfinite(areas[s].sum_of_squares))
      throw BadConfiguration(
          fmt::format("instance {}: the sum of squared areas is {}, expected a finite number",
                      scene.stored[s], areas[s].sum_of_squares));
  scene.sizes = resolution_sizes(options.rule, areas);
  return scene;
}

std::optional<LayoutPlan> make_plan(PlanScene& scene, const Density& density, std::uint64_t limit) {
  auto unclustered = plan_unclustered(scene, density, limit);
  if (!unclustered || !cluster(scene, unclustered->clusterable, limit, unclustered->plan))
    return std::nullopt;
  return std::move(unclustered->plan);
}

bool plan_fits(PlanScene& scene, const Density& density, std::uint64_t limit,
               std::optional<LayoutPlan>& plan) {
  plan.reset();
  auto unclustered = plan_unclustered(scene, density, limit);
  if (!unclustered) return false;
  std::uint64_t most = unclustered->plan.node_count;
  for (const Clusterable& levels : unclustered->clusterable)
    most += std::popcount(levels.levels) *
            count_nodes(scene, levels.stored, unclustered->plan.instances[levels.stored][levels.first()]);
  if (most <= limit) return true;
  if (!cluster(scene, unclustered->clusterable, limit, unclustered->plan)) return false;
  plan = std::move(unclustered->plan);
  return true;
}

}  // namespace gatelight::neural
