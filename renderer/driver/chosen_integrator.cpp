#include "renderer/driver/chosen_integrator.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <vector>

#include "renderer/film/film_samples.h"
#include "renderer/film/sample_order.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/transport/path_integrator.h"

namespace gatelight::renderer {

double bounces_of_paths(const World& world, const Camera& camera, const PixelRect& region,
                        const RenderOptions& options) {
  constexpr std::uint64_t kPaths = 8192, kTogether = 256;
  const FilterSampler filter(options.filter, options.filter_width);
  const SampleOrder order(region);
  const PathIntegrator integrator(world, path_integrator_options(options));
  const std::uint64_t bounces = tbb::parallel_reduce(
      tbb::blocked_range<std::uint64_t>(0, kPaths, kTogether), std::uint64_t{0},
      [&](const tbb::blocked_range<std::uint64_t>& range, std::uint64_t sum) {
        std::vector<CameraSample> samples;
        for (std::uint64_t i = range.begin(); i < range.end(); ++i)
          samples.push_back(make_camera_sample(order.at(i), options, camera, filter));
        std::vector<SampleResult> results(samples.size());
        PathIntegrator::Scratch scratch;
        RayCounts rays;
        integrator.trace(samples, results, {}, rays, scratch);
        return sum + rays.bounce;
      },
      [](std::uint64_t a, std::uint64_t b) { return a + b; });
  return static_cast<double>(bounces) / static_cast<double>(kPaths);
}

RenderOptions with_integrator(RenderOptions options, double bounces) {
  const bool cached =
      bounces >= kBouncesForCache || !options.cache.cache_in.empty() || !options.cache.cache_out.empty();
  use_integrator(options, cached ? options.integrator : Integrator::path);
  return options;
}

}  // namespace gatelight::renderer
