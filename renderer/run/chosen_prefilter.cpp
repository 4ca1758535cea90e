#include "renderer/run/chosen_prefilter.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <functional>
#include <vector>

#include "renderer/film/sample_order.h"
#include "renderer/transport/path_integrator.h"

namespace gatelight::renderer {
namespace {

/// The squared distance of two guides that is noise.
constexpr float kNoise = 0.01f;

bool differ(const GuideSurface& a, const GuideSurface& b) {
  return a.hit != b.hit || (a.albedo - b.albedo).square().sum() > kNoise ||
         (a.normal - b.normal).squaredNorm() > kNoise;
}

}  // namespace

double noisy_share_of_guides(const World& world, const Camera& camera, const PixelRect& region,
                             const RenderOptions& options) {
  constexpr std::uint64_t kPixels = 4096, kTogether = 128;
  const SampleOrder order(region);
  const PathIntegrator integrator(world, path_integrator_options(options));
  const std::uint64_t noisy = tbb::parallel_reduce(
      tbb::blocked_range<std::uint64_t>(0, kPixels, kTogether), std::uint64_t{0},
      [&](const tbb::blocked_range<std::uint64_t>& range, std::uint64_t sum) {
        std::vector<CameraSample> samples;
        for (std::uint64_t i = range.begin(); i < range.end(); ++i) {
          const Pixel pixel = order.at(i).pixel;
          for (const std::uint32_t number : {0u, 1u}) {
            CameraSample& s = samples.emplace_back();
            s.sampler = Sampler(options.sampler, options.seed, static_cast<std::uint32_t>(pixel.x),
                                static_cast<std::uint32_t>(pixel.y), number);
            s.seed = hash(hash(options.seed + number) + static_cast<std::uint32_t>(i));
            s.camera_ray = camera_ray(camera, static_cast<float>(pixel.x) + 0.5f,
                                      static_cast<float>(pixel.y) + 0.5f, s.sampler);
          }
        }
        std::vector<SampleResult> results(samples.size());
        std::vector<FirstHit> hits(samples.size());
        PathIntegrator::Scratch scratch;
        RayCounts rays;
        integrator.trace(samples, results, hits, rays, scratch);
        for (std::size_t i = 0; i < hits.size(); i += 2)
          sum += differ(hits[i].guide, hits[i + 1].guide) ? 1 : 0;
        return sum;
      },
      std::plus<>());
  return static_cast<double>(noisy) / static_cast<double>(kPixels);
}

}  // namespace gatelight::renderer
