#include "neural/layout/plan.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "neural/errors.h"
#include "neural/layout/resolution.h"
#include "neural/layout/surface_areas.h"
#include "neural/mesh_colors.h"

namespace gatelight::neural {

namespace {

const SurfaceInstance& instance_of(const PlanScene& scene, std::size_t stored) {
  return scene.surfaces.instances[scene.stored[stored]];
}

std::span<const std::uint32_t> levels(const PlanScene& scene, const InstancePlan& plan) {
  return {plan.resolutions.data(), scene.options.stack.size()};
}

bool has_edges(const PlanScene& scene, const InstancePlan& plan) {
  return std::ranges::any_of(levels(scene, plan), [](std::uint32_t r) { return r > 1; });
}

/// Of all levels and sides, without edges that are not known yet.
std::uint64_t count_nodes(const PlanScene& scene, std::size_t stored, const InstancePlan& plan) {
  const std::uint32_t mesh = instance_of(scene, stored).mesh;
  const std::uint64_t triangles = scene.surfaces.meshes[mesh].triangles.size();
  std::uint64_t nodes = 0;
  for (const std::uint32_t r : levels(scene, plan))
    nodes += scene.options.storage == NodeStorage::per_triangle
                 ? triangles * nodes_per_triangle(r)
                 : plan.vertex_nodes + std::uint64_t{scene.meshes[mesh].edge_count} * nodes_per_edge(r) +
                       triangles * nodes_per_interior(r);
  return nodes * side_count(instance_of(scene, stored).sides);
}

/// Applies `add` to the mesh of each listed instance, once a mesh.
template <class Add>
void add_to_meshes(PlanScene& scene, std::span<const std::size_t> stored, const Add& add) {
  std::vector<std::uint32_t> numbers;
  for (const std::size_t s : stored) numbers.push_back(instance_of(scene, s).mesh);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  tbb::parallel_for(std::size_t{0}, numbers.size(),
                    [&](std::size_t i) { add(scene.meshes[numbers[i]], scene.surfaces.meshes[numbers[i]]); });
}

/// Each instance by itself. False when there are more than `limit` nodes with the `nodes` counted so far.
bool cluster_instances(PlanScene& scene, std::span<const std::size_t> stored, std::uint64_t limit,
                       LayoutPlan& plan) {
  const std::uint64_t counted = plan.node_count;
  std::atomic<std::uint64_t> nodes = counted;
  std::atomic<bool> over = false;
  tbb::parallel_for(std::size_t{0}, stored.size(), [&](std::size_t i) {
    if (over) return;
    InstancePlan& instance = plan.instances[stored[i]];
    const std::uint64_t per_cluster =
        scene.options.stack.size() * side_count(instance_of(scene, stored[i]).sides);
    // As many clusters as vertices bring nothing.
    const std::uint64_t most = std::min(instance.vertex_nodes - 1, (limit - counted) / per_cluster);
    const ClusterInstance clustered = cluster_instance(scene, stored[i]);
    if (const auto count = count_clusters({&clustered, 1}, cluster_grid(plan.density), most)) {
      instance.vertex_nodes = *count;
      instance.clustered = true;
    }
    const std::uint64_t added = instance.vertex_nodes * per_cluster;
    if (nodes.fetch_add(added) + added > limit) over = true;
  });
  plan.node_count = nodes;
  return !over;
}

bool cluster_scene(PlanScene& scene, std::span<const std::size_t> stored, std::uint64_t limit,
                   LayoutPlan& plan) {
  std::vector<ClusterInstance> instances;
  for (const std::size_t s : stored) {
    plan.instances[s].clustered = true;
    plan.scene_sides |= static_cast<std::uint32_t>(instance_of(scene, s).sides);
    instances.push_back(cluster_instance(scene, s));
  }
  if (instances.empty()) return true;
  const std::uint64_t per_cluster = scene.options.stack.size() * std::popcount(plan.scene_sides);
  const auto count =
      count_clusters(instances, cluster_grid(plan.density), (limit - plan.node_count) / per_cluster);
  if (!count) return false;
  plan.scene_clusters = *count;
  plan.node_count += *count * per_cluster;
  return true;
}

bool cluster(PlanScene& scene, std::span<const std::size_t> stored, std::uint64_t limit, LayoutPlan& plan) {
  if (cluster_grid(plan.density).normals) add_to_meshes(scene, stored, add_normals);
  return clusters_scene(plan.density) ? cluster_scene(scene, stored, limit, plan)
                                      : cluster_instances(scene, stored, limit, plan);
}

/// A plan that counts the nodes of all instances but the clusterable ones.
struct UnclusteredPlan {
  LayoutPlan plan;
  std::vector<std::size_t> clusterable;  ///< stored instances
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
  std::vector<std::size_t> others;
  for (std::size_t s = 0; s < scene.stored.size(); ++s) {
    InstancePlan& instance = plan.instances[s];
    const std::uint32_t adaptive =
        adaptive_resolution(options, scene.sizes[s], density.node_spacing, density.resolution_scale);
    for (std::size_t l = 0; l < options.stack.size(); ++l)
      instance.resolutions[l] = level_resolution(options.stack[l], adaptive);
    if (shared) instance.vertex_nodes = scene.meshes[instance_of(scene, s).mesh].vertices.size();
    if (has_edges(scene, instance))
      edged.push_back(s);
    else if (may_cluster && instance.vertex_nodes > 0)
      result.clusterable.push_back(s);
    else
      others.push_back(s);
  }
  const auto fits = [&] {
    plan.node_count = 0;
    for (const std::size_t s : edged) plan.node_count += count_nodes(scene, s, plan.instances[s]);
    for (const std::size_t s : others) plan.node_count += count_nodes(scene, s, plan.instances[s]);
    return plan.node_count <= limit;
  };
  if (!fits()) return std::nullopt;  // before the edges are looked for
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

ClusterGrid cluster_grid(const Density& density) {
  return {0.5 * density.node_spacing, density.scope != ClusterScope::instance};
}

ClusterInstance cluster_instance(const PlanScene& scene, std::size_t stored) {
  const SurfaceInstance& instance = instance_of(scene, stored);
  return {&scene.surfaces.meshes[instance.mesh], &scene.meshes[instance.mesh],
          to_transform(instance.object_to_world)};
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
    tbb::parallel_for(std::size_t{0}, used.size(), [&](std::size_t m) {
      if (used[m] != 0) scene.meshes[m] = number_vertices(surfaces.meshes[m]);
    });
  }
  std::vector<SurfaceAreas> areas(scene.stored.size());
  if (options.rule != ResolutionRule::fixed && std::ranges::any_of(options.stack, is_adaptive))
    tbb::parallel_for(std::size_t{0}, areas.size(), [&](std::size_t s) {
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

bool plan_fits(PlanScene& scene, const Density& density, std::uint64_t limit) {
  auto unclustered = plan_unclustered(scene, density, limit);
  if (!unclustered) return false;
  std::uint64_t most = unclustered->plan.node_count;
  for (const std::size_t s : unclustered->clusterable)
    most += count_nodes(scene, s, unclustered->plan.instances[s]);
  return most <= limit || cluster(scene, unclustered->clusterable, limit, unclustered->plan);
}

}  // namespace gatelight::neural
