#pragma once
// A path tracer that only traces: the speed limit of any renderer on the same scene with the same Embree. It
// has the same camera rays, at most the same bounces, and one shadow ray per hit. Directions are
// cosine-distributed about the geometric normal. It has no materials, no textures, no interpolation and no
// Russian roulette.

#include <cstdint>
#include <span>
#include <vector>

#include "bench/world_fixture.h"

namespace gatelight::bench {

class TracingOnly {
 public:
  explicit TracingOnly(const WorldFixture& world);

  /// Traces one camera path for each sample by single rays, depth first. Returns the number of rays.
  std::uint64_t trace(std::span<const renderer::CameraSample> samples) const;

 private:
  const BareEmbree& bare_;
  std::vector<Vec3> light_points_;  ///< on the emissive triangles; if empty, a sun overhead
};

}  // namespace gatelight::bench
