#pragma once
// Reference ambient occlusion at the primary hit: the cosine-weighted fraction of the hemisphere about the
// smooth normal that is unoccluded within a distance. The background is unoccluded.

#include <functional>
#include <span>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/transport/occlusion.h"

namespace gatelight::renderer {

class AoIntegrator {
 public:
  struct Scratch {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    OcclusionRays occlusion;
  };

  /// distance: metres, may be infinite.
  AoIntegrator(const World& world, float distance) : world_(world), distance_(distance) {}

  /// Returns whether the sample's result comes from elsewhere, so that no occlusion ray is needed.
  using Elsewhere = std::function<bool(std::size_t sample, const Hit&, const Surface&, const Ray&)>;

  /// Like PathIntegrator::trace. `elsewhere` may be empty.
  void trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
             std::span<FirstHit> first_hits, RayCounts& rays, Scratch& scratch,
             const Elsewhere& elsewhere = {}) const;

 private:
  const World& world_;
  float distance_;
};

}  // namespace gatelight::renderer
