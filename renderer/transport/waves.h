#pragma once
// Paths are followed breadth first, in waves: all rays of a depth are traced together in packets, then all
// hits are shaded, most of them in blocks, then all shadow rays are traced.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "renderer/settings/statistics.h"
#include "renderer/transport/trace_timer.h"
#include "renderer/transport/walker.h"

namespace gatelight::renderer {

/// Every ray that was traced, in order: benchmarks replay them.
struct RayLog {
  std::vector<Ray> camera;
  std::vector<Ray> bounce;
  std::vector<Ray> shadow;
};

/// Kinds of blocks that an integrator may fill side by side.
inline constexpr int kBlockKinds = 3;

/// The memory of one thread. `Pending` is a light sample whose shadow ray has not been traced yet.
template <typename Path, typename Pending>
struct Waves {
  RayLog* log = nullptr;  ///< null: rays are not logged
  std::vector<Path> paths;
  std::vector<Ray> rays;  ///< one for each path
  std::vector<Hit> hits;
  std::vector<Ray> shadow_rays;
  std::vector<Pending> pending;  ///< one for each shadow ray
  std::vector<Color> transmittance;
  std::vector<std::uint8_t> goes_on;  ///< one for each path
  PathBlock blocks[kBlockKinds];
};

/// What becomes of a path at its hit: it ends, it has its next ray, or it waits in a block.
struct Step {
  bool goes_on = false;
  PathBlock* waits = nullptr;
};

/// Data is prefetched so many hits ahead of shading.
inline constexpr std::size_t kTriangleAhead = 8;
inline constexpr std::size_t kVerticesAhead = 4;

/// Prefetches the data of hits that are shaded soon after the one at `index`.
inline void prefetch(const Surfaces& surfaces, std::span<const Hit> hits, std::size_t index) {
  if (index + kTriangleAhead < hits.size()) surfaces.prefetch_triangle(hits[index + kTriangleAhead]);
  if (index + kVerticesAhead < hits.size()) surfaces.prefetch_vertices(hits[index + kVerticesAhead]);
}

/// Follows the paths until none is left. `first_hits` is empty or has the hits of the first rays.
/// scatter(number, path, ray, hit) returns the path's Step; it adds shadow rays with their pending light
/// samples. shade(block) does the same for the paths of a block and sets `goes_on` of each. arrive(pending,
/// transmittance) is called for each light sample.
template <typename Path, typename Pending, typename Scatter, typename Shade, typename Arrive>
void trace_waves(const World& world, std::span<const Hit> first_hits, Waves<Path, Pending>& waves,
                 RayCounts& counts, Scatter scatter, Shade shade, Arrive arrive) {
  auto& [log, paths, rays, hits, shadow_rays, pending, transmittance, goes_on, blocks] = waves;
  const auto empty = [&](PathBlock& block) {
    shade(block);
    block.points.count = 0;
  };
  const auto append = [](std::vector<Ray>& to, const std::vector<Ray>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (bool first = true; !paths.empty(); first = false) {
    hits.resize(paths.size());
    if (first && !first_hits.empty()) {
      std::copy(first_hits.begin(), first_hits.end(), hits.begin());
    } else {
      (first ? counts.camera : counts.bounce) += paths.size();
      const TraceTimer timer(counts);
      world.accel.intersect(rays, hits, first);
      if (log) append(first ? log->camera : log->bounce, rays);
    }

    shadow_rays.clear();
    pending.clear();
    goes_on.resize(paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      prefetch(world.surfaces, hits, i);
      const Step step = scatter(static_cast<std::uint32_t>(i), paths[i], rays[i], hits[i]);
      goes_on[i] = step.goes_on;
      if (step.waits && step.waits->full()) empty(*step.waits);
    }
    for (PathBlock& block : blocks) {
      if (block.points.count > 0) empty(block);
    }
    std::size_t alive = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (!goes_on[i]) continue;
      if (alive != i) {
        paths[alive] = paths[i];
        rays[alive] = rays[i];
      }
      ++alive;
    }
    paths.resize(alive);
    rays.resize(alive);

    counts.shadow += shadow_rays.size();
    transmittance.resize(shadow_rays.size());
    {
      const TraceTimer timer(counts);
      world.accel.transmittance(shadow_rays, transmittance);
    }
    if (log) append(log->shadow, shadow_rays);
    for (std::size_t i = 0; i < pending.size(); ++i) arrive(pending[i], transmittance[i]);
  }
}

}  // namespace gatelight::renderer
