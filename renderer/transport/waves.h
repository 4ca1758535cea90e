#pragma once
// Paths are followed breadth first, in waves: all rays of a depth are traced together in packets, then all
// hits are shaded, most of them in blocks, then all shadow rays are traced.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "renderer/settings/statistics.h"
#include "renderer/transport/path_state.h"
#include "renderer/transport/trace_timer.h"

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
  // The wave: rays, the path of each, and their hits.
  std::vector<Ray> rays;
  std::vector<std::uint32_t> path_of;
  std::vector<Hit> hits;
  // The next wave.
  std::vector<Ray> next_rays;
  std::vector<std::uint32_t> next_path_of;
  std::vector<Ray> shadow_rays;
  std::vector<Pending> pending;  ///< one for each shadow ray
  std::vector<Color> transmittance;
  /// Blocks of paths that wait to be shaded. Lanes without a path contain zeros or an earlier path.
  /// Of each kind one block for the kernels and one for the scalar code.
  PathBlock blocks[kBlockKinds][2] = {};

  Waves() {
    for (auto& kind : blocks) kind[1].make_scalar();
  }

  /// The block of a kind where a path waits.
  PathBlock& block_of(int kind, bool kernels) { return blocks[kind][kernels ? 0 : 1]; }
  int kind_of(const PathBlock& block) const { return static_cast<int>((&block - &blocks[0][0]) / 2); }

  /// Adds the next ray of the path of ray `number`.
  void push_next_ray(std::uint32_t number, const Ray& next) {
    next_rays.push_back(next);
    next_path_of.push_back(path_of[number]);
  }
};

/// Number of hits by which prefetching is ahead of shading.
inline constexpr std::size_t kTriangleAhead = 8;
inline constexpr std::size_t kVerticesAhead = 4;

/// Prefetches the data of hits that are shaded soon after the one at `index`.
inline void prefetch(const Surfaces& surfaces, std::span<const Hit> hits, std::size_t index) {
  if (index + kTriangleAhead < hits.size()) surfaces.prefetch_triangle(hits[index + kTriangleAhead]);
  if (index + kVerticesAhead < hits.size()) surfaces.prefetch_vertices(hits[index + kVerticesAhead]);
}

/// Follows the paths until none is left; `paths` and `rays` are the first wave. `first_hits` is empty or has
/// the hits of its rays. scatter(number, path, ray, hit) shades the hit of a ray: it calls push_next_ray()
/// where the path has its next ray, and adds shadow rays with their pending light samples. Or it returns a
/// block in which the path waits. shade(block) does the same for all rays of a block. accumulate(pending,
/// transmittance) is called for each light sample.
template <typename Path, typename Pending, typename Scatter, typename Shade, typename Accumulate>
void trace_waves(const World& world, std::span<const Hit> first_hits, Waves<Path, Pending>& waves,
                 RayCounts& counts, Scatter scatter, Shade shade, Accumulate accumulate) {
  const auto append = [](std::vector<Ray>& to, const std::vector<Ray>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  const auto flush = [&](PathBlock& block) {
    shade(block);
    block.points.count = 0;
  };
  waves.path_of.resize(waves.paths.size());
  std::iota(waves.path_of.begin(), waves.path_of.end(), 0u);
  for (bool first = true; !waves.rays.empty(); first = false) {
    const std::vector<Ray>& rays = waves.rays;
    std::vector<Hit>& hits = waves.hits;
    hits.resize(rays.size());
    if (first && !first_hits.empty()) {
      std::copy(first_hits.begin(), first_hits.end(), hits.begin());
    } else {
      (first ? counts.camera : counts.bounce) += rays.size();
      const TraceTimer timer(counts);
      world.accel.intersect(rays, hits, first);
      if (waves.log) append(first ? waves.log->camera : waves.log->bounce, rays);
    }

    waves.shadow_rays.clear();
    waves.pending.clear();
    waves.next_rays.clear();
    waves.next_path_of.clear();
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      prefetch(world.surfaces, hits, i);
      PathBlock* const block = scatter(i, waves.paths[waves.path_of[i]], waves.rays[i], hits[i]);
      if (block && block->full()) flush(*block);
    }
    for (auto& kind : waves.blocks) {
      for (PathBlock& block : kind) {
        if (block.points.count > 0) flush(block);
      }
    }
    waves.rays.swap(waves.next_rays);
    waves.path_of.swap(waves.next_path_of);

    counts.shadow += waves.shadow_rays.size();
    waves.transmittance.resize(waves.shadow_rays.size());
    {
      const TraceTimer timer(counts);
      world.accel.transmittance(waves.shadow_rays, waves.transmittance);
    }
    if (waves.log) append(waves.log->shadow, waves.shadow_rays);
    for (std::size_t i = 0; i < waves.pending.size(); ++i)
      accumulate(waves.pending[i], waves.transmittance[i]);
  }
}

}  // namespace gatelight::renderer
