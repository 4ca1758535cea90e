#pragma once
// Unbiased path tracing: next-event estimation and BSDF sampling joined by multiple importance sampling
// (Veach 1997), Russian roulette. It does not use the cache.

#include <span>
#include <vector>

#include "renderer/film/light_parts.h"
#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/lobe_shares.h"
#include "renderer/transport/path_state.h"
#include "renderer/transport/waves.h"

namespace gatelight::renderer {

/// The options that the path tracer reads.
struct PathIntegratorOptions {
  MisRule mis;
  int max_depth = kNoDepthLimit;  ///< scattering events
  int max_transmission_depth = kNoDepthLimit;
  int min_depth = 2;        ///< before Russian roulette
  std::vector<Aov> passes;  ///< render passes
};
inline PathIntegratorOptions path_integrator_options(const RenderOptions& options) {
  return {{options.direct, options.mis},
          options.max_depth.value_or(kNoDepthLimit),
          options.max_transmission_depth.value_or(kNoDepthLimit),
          options.min_depth,
          passes_among(options.aovs)};
}

/// Traces batches of camera paths breadth first: all rays of a depth together, in packets. Thread-safe; the
/// scratch memory belongs to the caller's thread.
class PathIntegrator {
 public:
  struct Scratch;

  /// The world must outlive the integrator.
  PathIntegrator(const World& world, const PathIntegratorOptions& options)
      : context_(world, options.mis, options.max_transmission_depth),
        options_(options),
        by_lobe_(world.masks.by_lobe()) {
    if (!options.passes.empty() || by_lobe_) context_.shading.separate_wide(kOnlyDiffuse);
  }

  /// Radiance of each sample. `first_hits` is empty, or as long as the samples. Adds to `rays`. Where the
  /// world has light groups or there are passes, their parts are in Scratch::parts.
  void trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
             std::span<FirstHit> first_hits, RayCounts& rays, Scratch& scratch) const;

 private:
  /// `radiance` is the path's sum; `first` receives its first hit unless it is null.
  PathBlock* scatter(std::uint32_t number, PathState& path, Ray& ray, Hit& hit, Color& radiance,
                     FirstHit* first, RayCounts& counts, Scratch& scratch) const;
  /// Walks through the medium around a path. False: the path ends there.
  bool walk(PathState& path, Ray& ray, Hit& hit, FirstHit* first, RayCounts& counts, Scratch& scratch) const;
  /// Adds the light sample of a lane, unless it is black or roulette ends it.
  void add_light(const PathState& path, const PathBlock& block, int lane, Scratch& scratch) const;
  void shade(PathBlock& block, std::span<FirstHit> first_hits, Scratch& scratch) const;

  PathContext context_;
  PathIntegratorOptions options_;
  bool by_lobe_;
};

/// A light sample whose shadow ray has not been traced yet.
struct PendingLight {
  Color contribution{0.0f, 0.0f, 0.0f};
  std::uint32_t index = 0;
  std::uint32_t light = 0;  ///< LightSample::light
  LobeShare lobes;          ///< that reflect it at the first scattering event; only for passes
  bool direct = false;      ///< it is sampled there
};

struct PathIntegrator::Scratch : Waves<PathState, PendingLight> {
  LightParts parts;
};

}  // namespace gatelight::renderer
