#pragma once
// Embree alone, with the triangles, build quality and robustness of the renderer, but without filter
// functions.

#include <embree3/rtcore.h>

#include <span>

#include "renderer/surface/ray.h"
#include "scene/scene.h"

namespace gatelight::bench {

/// A ray that has hit nothing yet.
inline RTCRayHit to_embree(const scene::Vec3& origin, const scene::Vec3& direction, float t_min,
                           float t_max) {
  RTCRayHit ray{};
  ray.ray = {origin.x(), origin.y(), origin.z(), t_min, direction.x(), direction.y(), direction.z(), 0.0f,
             t_max,      ~0u,        0,          0};
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

class BareEmbree {
 public:
  explicit BareEmbree(const scene::Scene& scene);
  ~BareEmbree();
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  RTCScene scene() const { return scene_; }

  void trace_single(std::span<const renderer::Ray> rays, bool shadow) const;
  void trace_packets(std::span<const renderer::Ray> rays, bool shadow, bool coherent) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace gatelight::bench
