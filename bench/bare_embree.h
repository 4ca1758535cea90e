#pragma once
// Embree alone, with the triangles, build quality and robustness of the renderer, but without filter
// functions.

#include <embree3/rtcore.h>

#include <span>

#include "renderer/surface/ray.h"
#include "scene/scene.h"

namespace gatelight::bench {

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
