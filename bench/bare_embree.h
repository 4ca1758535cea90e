#pragma once
// Bare Embree, with the triangles and the build quality of the renderer, but without filter functions.

#include <cstddef>
#include <cstdint>
#include <span>

#include "renderer/surface/embree_api.h"
#include "renderer/surface/ray.h"
#include "scene/scene.h"

namespace gatelight::bench {

/// A ray that has hit nothing yet.
inline RTCRayHit to_embree(const Vec3& origin, const Vec3& direction, float t_min, float t_max) {
  RTCRayHit ray{};
  ray.ray = {origin.x(), origin.y(), origin.z(), t_min, direction.x(), direction.y(), direction.z(), 0.0f,
             t_max,      ~0u,        0,          0};
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

/// The renderer's scenes are robust.
enum class Watertight : std::uint8_t { robust, fast };

class BareEmbree {
 public:
  explicit BareEmbree(const scene::Scene& scene, Watertight watertight = Watertight::robust);
  ~BareEmbree();
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  RTCScene scene() const { return scene_; }

  void trace_single(std::span<const renderer::Ray> rays, bool shadow) const;
  /// Returns the number of rays that hit nothing.
  std::size_t trace_packets(std::span<const renderer::Ray> rays, bool shadow, bool coherent) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace gatelight::bench
