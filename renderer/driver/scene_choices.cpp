#include "renderer/driver/scene_choices.h"

#include <algorithm>
#include <vector>

#include "base/parallel/loops.h"
#include "renderer/film/film_samples.h"
#include "renderer/film/sample_order.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/transport/path_integrator.h"

namespace gatelight::renderer {
namespace {

constexpr std::size_t kPaths = 8192, kTogether = 256;

/// Sums over paths.
struct PathSums {
  RayCounts rays;
  std::size_t hits = 0;
  double light = 0.0, unshadowed = 0.0;
};

/// Luminance of a white surface at `p` by one light sample, from any side.
double unshadowed(const World& world, const Vec3& p, const Sampler& sampler) {
  constexpr std::uint32_t kLight = dimension::kFirstVertex;
  const LightSample light =
      world.lights.sample(p, Vec3::Zero(), sampler.get_1d(kLight + dimension::kLightChoice),
                          sampler.get_2d(kLight + dimension::kLightPoint));
  double sum = 0.0;
  if (light.pdf > 0.0f) sum += static_cast<double>(luminance(light.radiance) / light.pdf) / kPi;
  // Light samples may leave a constant environment to bounces.
  return std::max(sum, static_cast<double>(luminance(world.environment.mean())));
}

}  // namespace

PilotPaths trace_pilot_paths(const World& world, const Camera& camera, const PixelRect& region,
                             const RenderOptions& options) {
  const FilterSampler filter(options.filter, options.filter_width);
  const SampleOrder order(region);
  const PathIntegrator integrator(world, path_integrator_options(options));
  std::vector<PathSums> parts(kPaths / kTogether);
  for_each(parts.size(), [&](std::size_t part) {
    std::vector<CameraSample> samples;
    for (std::size_t i = part * kTogether; i < (part + 1) * kTogether; ++i)
      samples.push_back(make_camera_sample(order.at(i), options, camera, filter));
    std::vector<SampleResult> results(samples.size());
    std::vector<FirstHit> first_hits(samples.size());
    PathIntegrator::Scratch scratch;
    PathSums& sums = parts[part];
    integrator.trace(samples, results, first_hits, sums.rays, scratch);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!first_hits[i].hit || !results[i].radiance.isFinite().all()) continue;
      ++sums.hits;
      sums.light += static_cast<double>(luminance(results[i].radiance));
      sums.unshadowed += unshadowed(world, first_hits[i].position - world.scene.origin, samples[i].sampler);
    }
  });
  PathSums all;
  for (const PathSums& part : parts) {
    all.rays.add(part.rays);
    all.hits += part.hits;
    all.light += part.light;
    all.unshadowed += part.unshadowed;
  }
  const auto hits = static_cast<double>(std::max<std::size_t>(all.hits, 1));
  return {static_cast<double>(all.rays.bounce - all.rays.walk) / kPaths,
          static_cast<double>(all.rays.walk) / kPaths, all.light / hits, all.unshadowed / hits};
}

RenderOptions with_choices(RenderOptions options, const PilotPaths& paths) {
  if (options.choose_integrator) {
    const bool cached = paths.bounces >= kBouncesForCache + paths.walk || !options.cache.cache_in.empty() ||
                        !options.cache.cache_out.empty();
    use_integrator(options, cached ? options.integrator : Integrator::path);
  }
  if (options.watertight == Watertight::automatic) {
    const bool dim = paths.unshadowed <= kLightBehindWalls * paths.light;
    options.watertight = dim ? Watertight::off : Watertight::on;
  }
  return options;
}

}  // namespace gatelight::renderer
