#pragma once
// A path tracer that only traces: the speed limit of any renderer on the same scene with the same Embree.
// Same camera rays, at most the same bounces and one shadow ray a hit, cosine-distributed directions about
// the geometric normal; no materials, no textures, no interpolation, no Russian roulette.

#include <cstdint>
#include <span>
#include <vector>

#include "bench/world_fixture.h"

namespace gatelight::bench {

class TracingOnly {
 public:
  explicit TracingOnly(const WorldFixture& world);

  /// Traces one camera path each, single rays, depth first. Returns the number of rays.
  std::uint64_t trace(std::span<const renderer::CameraSample> samples) const;

 private:
  const BareEmbree& bare_;
  std::vector<scene::Vec3> light_points_;  ///< on the emissive triangles; empty: a sun overhead
};

}  // namespace gatelight::bench
