#include "renderer/cache/cache_report.h"

#include <algorithm>

#include "neural/layout/mesh_colors.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/cache_session.h"
#include "renderer/cache/scene_layout.h"

namespace gatelight::renderer {
namespace {

/// Nodes of one level of a surface. Corners and edges are numbered without gaps.
std::uint64_t count_nodes(const neural::GateLayout& layout, std::size_t surface,
                          const neural::GateSurfaceLevel& level) {
  const neural::GateSurface& s = layout.surfaces[surface];
  const std::uint32_t resolution = level.resolution;
  if (layout.storage == neural::NodeStorage::per_triangle)
    return std::uint64_t{s.triangle_count} * neural::nodes_per_triangle(resolution);
  std::uint32_t corners = 0;
  std::uint32_t edges = 0;
  for (std::uint32_t t = 0; t < s.triangle_count; ++t) {
    const std::uint32_t* const words =
        layout.topology.data() + s.topology_offset + std::size_t{t} * s.topology_stride;
    for (std::uint32_t c = 0; c < 3; ++c) {
      corners = std::max(corners, words[level.corners + c] + 1);
      if (resolution > 1) edges = std::max(edges, words[neural::kTopologyEdges + c] + 1);
    }
  }
  return corners + std::uint64_t{edges} * neural::nodes_per_edge(resolution) +
         std::uint64_t{s.triangle_count} * neural::nodes_per_interior(resolution);
}

CacheInstanceReport describe(const scene::Scene& scene, const neural::GateLayout& layout, std::size_t index,
                             neural::Sides sides) {
  const scene::Instance& instance = scene.instances[index];
  CacheInstanceReport report;
  report.name = instance.name.empty() ? scene.mesh_of(instance).name : instance.name;
  report.triangles = scene.mesh_of(instance).triangles.size();
  for (std::uint32_t side = 0; side < 2; ++side) {
    if (!has_side(sides, side)) continue;
    ++report.sides;
    const std::size_t surface = 2 * index + side;
    report.resolutions.clear();
    for (std::uint32_t level = 0; level < layout.stack; ++level) {
      const neural::GateSurfaceLevel& placed = layout.levels[surface * layout.stack + level];
      report.resolutions.push_back(placed.resolution);
      report.nodes += count_nodes(layout, surface, placed);
    }
  }
  return report;
}

}  // namespace

CacheReport report_cache(const World& world, const Camera& camera, const PixelRect& region,
                         const RenderOptions& options) {
  CacheReport report;
  const CacheSession session(world, camera, region, options);
  report.statistics = session.statistics();
  report.bytes_without_scouting = report.statistics.parameter_bytes;
  if (options.cache.encoding != neural::FeatureEncoding::gate) return report;
  for (std::size_t i = 0; i < world.scene.instances.size(); ++i)
    report.instances.push_back(describe(world.scene, session.model().gate, i, session.setup().sides[i]));
  // The same spacing, but with storage for every side that materials show.
  CacheSetup everything = session.setup();
  for (std::size_t i = 0; i < everything.sides.size(); ++i)
    everything.sides[i] = possible_sides(world.scene, world.scene.instances[i]);
  RenderOptions unbounded = options;
  unbounded.cache.memory_bytes = 0;
  unbounded.cache.node_spacing = everything.node_spacing = session.model().gate.report.node_spacing;
  report.bytes_without_scouting =
      make_cache_model(world, unbounded, everything)->parameters.count *
      (options.cache.training.precision == neural::FeaturePrecision::fp32 ? 4 : 2);
  return report;
}

}  // namespace gatelight::renderer
