#pragma once
// Unbiased path tracing: next-event estimation and BSDF sampling joined by multiple importance sampling
// (Veach 1997), Russian roulette. Knows nothing of any cache.

#include <span>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/scattering.h"
#include "renderer/transport/waves.h"
#include "renderer/transport/world.h"

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
  struct Path;
  bool scatter(Path& path, Ray& ray, const Hit& hit, std::span<SampleResult> results,
               std::span<FirstHit> first_hits, Scratch& scratch) const;
  void add_direct_light(const Path& path, const Surface& surface, const Bsdf& bsdf, const Vec3& normal,
                        Scratch& scratch) const;

  const World& world_;
  const RenderOptions& options_;
  MisRule mis_;
};

struct PathIntegrator::Path {
  RayCone cone;
  Color throughput{1.0f, 1.0f, 1.0f};  ///< of power
  Color absorption{0.0f, 0.0f, 0.0f};  ///< per metre, of the medium the ray travels in
  Departure departure;
  /// Product of BsdfSample::radiance_scale: not a loss of power. In double, since hundreds of media inside
  /// each other leave single precision before they come back to 1.
  double radiance_scale = 1.0;
  std::int32_t depth = 0;   ///< scattering events so far
  std::int32_t vertex = 0;  ///< surfaces met so far: the block of sampler dimensions
  std::uint32_t index = 0;  ///< into samples and results
  std::uint32_t seed = 0;
  Sampler sampler;

  /// What radiance at the ray's end is worth at the camera.
  Color carried() const { return throughput * static_cast<float>(radiance_scale); }
};

/// A light sample on its way through the scene.
struct PendingLight {
  Color contribution{0.0f, 0.0f, 0.0f};
  std::uint32_t index = 0;
};

struct PathIntegrator::Scratch : Waves<PathIntegrator::Path, PendingLight> {};

}  // namespace gatelight::renderer
