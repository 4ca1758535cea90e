#pragma once
// The rays of ambient occlusion: one definition for the reference, for pictures from the cache and for its
// records.

#include <cstdint>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/sampling/warp.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/trace_timer.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// Collects rays, each with a number that the caller chooses, and traces them together. Memory is reused.
class OcclusionRays {
 public:
  /// Adds a cosine-weighted ray about the smooth normal, `distance` metres long. Returns false where the
  /// direction lies below the surface, which counts as occluded.
  bool add(const Surface& surface, const CameraSample& sample, float distance, std::size_t number) {
    Ray ray;
    ray.direction = Basis(surface.smooth_normal)
                        .to_world(sample_cosine_hemisphere(
                            sample.sampler.get_2d(dimension::kFirstVertex + dimension::kBsdfDirection)));
    if (!(ray.direction.dot(surface.geometric_normal) > 0.0f)) return false;
    ray.origin = surface.spawn(ray.direction);
    ray.t_max = distance;
    ray.seed = hash(sample.seed + 1u);
    ray.time = sample.camera_ray.ray.time;
    ray.mask = ray_mask(scene::kShadowRays);
    rays_.push_back(ray);
    numbers_.push_back(number);
    return true;
  }

  /// Traces and removes all rays. Calls arrive(number, open) for each; `open` is the transmittance, 0 or 1
  /// except through panes.
  template <typename Arrive>
  void trace(const World& world, RayCounts& counts, Arrive arrive) {
    counts.shadow += rays_.size();
    open_.resize(rays_.size());
    {
      const TraceTimer timer(counts);
      world.accel.transmittance(rays_, open_);
    }
    for (std::size_t i = 0; i < rays_.size(); ++i) arrive(numbers_[i], open_[i]);
    rays_.clear();
    numbers_.clear();
  }

 private:
  std::vector<Ray> rays_;
  std::vector<std::size_t> numbers_;
  std::vector<Color> open_;
};

}  // namespace gatelight::renderer
