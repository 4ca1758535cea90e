#include "renderer/driver/chosen_integrator.h"

#include <atomic>
#include <vector>

#include "base/parallel/loops.h"
#include "renderer/film/film_samples.h"
#include "renderer/film/sample_order.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/transport/path_integrator.h"

namespace gatelight::renderer {

double bounces_of_paths(const World& world, const Camera& camera, const PixelRect& region,
                        const RenderOptions& options) {
  constexpr std::size_t kPaths = 8192, kTogether = 256;
  const FilterSampler filter(options.filter, options.filter_width);
  const SampleOrder order(region);
  const PathIntegrator integrator(world, path_integrator_options(options));
  std::atomic<std::uint64_t> bounces = 0;
  for_each_range(kPaths, kTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<CameraSample> samples;
    for (std::size_t i = begin; i < end; ++i)
      samples.push_back(make_camera_sample(order.at(i), options, camera, filter));
    std::vector<SampleResult> results(samples.size());
    PathIntegrator::Scratch scratch;
    RayCounts rays;
    integrator.trace(samples, results, {}, rays, scratch);
    bounces += rays.bounce - rays.walk;
  });
  return static_cast<double>(bounces) / static_cast<double>(kPaths);
}

RenderOptions with_integrator(RenderOptions options, double bounces) {
  const bool cached =
      bounces >= kBouncesForCache || !options.cache.cache_in.empty() || !options.cache.cache_out.empty();
  use_integrator(options, cached ? options.integrator : Integrator::path);
  return options;
}

}  // namespace gatelight::renderer
