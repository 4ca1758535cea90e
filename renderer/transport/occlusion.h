#pragma once
// The ray of ambient occlusion: one definition for the reference and for the cache's records.

#include "renderer/film/camera_sample.h"
#include "renderer/sampling/warp.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

/// Cosine-weighted about the smooth normal. False where the direction lies below the surface: occluded.
inline bool make_occlusion_ray(const Surface& surface, const CameraSample& sample, float distance, Ray& ray) {
  ray.direction = Basis(surface.smooth_normal)
                      .to_world(sample_cosine_hemisphere(
                          sample.sampler.get_2d(dimension::kFirstVertex + dimension::kBsdfDirection)));
  if (!(ray.direction.dot(surface.geometric_normal) > 0.0f)) return false;
  ray.origin = surface.spawn(ray.direction);
  ray.t_max = distance;
  ray.seed = hash(sample.seed + 1u);
  return true;
}

}  // namespace gatelight::renderer
