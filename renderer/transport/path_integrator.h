#pragma once
// Unbiased path tracing: next-event estimation and BSDF sampling joined by multiple importance sampling
// (Veach 1997), Russian roulette. Knows nothing of any cache.

#include <span>

#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/walker.h"
#include "renderer/transport/waves.h"

namespace gatelight::renderer {

/// Traces batches of camera paths breadth first: all rays of a depth together, in packets. Thread-safe; the
/// scratch memory belongs to the caller's thread.
class PathIntegrator {
 public:
  struct Scratch;

  PathIntegrator(const World& world, const RenderOptions& options);

  /// Radiance of each sample. `first_hits` is empty, or as long as the samples. Adds to `rays`.
  void trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
             std::span<FirstHit> first_hits, RayCounts& rays, Scratch& scratch) const;

 private:
  /// `radiance` is the path's; `first` is where its first hit is kept, or null.
  bool scatter(Walker& path, Ray& ray, const Hit& hit, Color& radiance, FirstHit* first,
               Scratch& scratch) const;

  Walk walk_;
  const RenderOptions& options_;
};

/// A light sample on its way through the scene.
struct PendingLight {
  Color contribution{0.0f, 0.0f, 0.0f};
  std::uint32_t index = 0;
};

struct PathIntegrator::Scratch : Waves<Walker, PendingLight> {};

}  // namespace gatelight::renderer
