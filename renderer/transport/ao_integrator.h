#pragma once
// Reference ambient occlusion at the primary hit: the cosine-weighted fraction of the hemisphere about the
// smooth normal that nothing hides within a distance. Background counts as open.

#include <span>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

class AoIntegrator {
 public:
  struct Scratch {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<Ray> shadow_rays;
    std::vector<std::uint32_t> index;
    std::vector<Color> transmittance;
  };

  /// distance: metres, may be infinite.
  AoIntegrator(const World& world, float distance) : world_(world), distance_(distance) {}

  /// As PathIntegrator::trace.
  void trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
             std::span<FirstHit> first_hits, RayCounts& rays, Scratch& scratch) const;

 private:
  const World& world_;
  float distance_;
};

}  // namespace gatelight::renderer
