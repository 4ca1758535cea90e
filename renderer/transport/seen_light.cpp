#include "renderer/transport/seen_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "renderer/film/film_samples.h"

namespace gatelight::renderer {
namespace {

/// Light differs much where the brighter one is so many times the other, and more than this share of the
/// picture's mean.
constexpr float kContrast = 2.0f;
constexpr double kLeastShare = 0.1;
/// Samples of the filter at an edge: at most, and at least so many times the picture's.
constexpr int kMostSamples = 256;
constexpr double kTimesMore = 2.0;
/// Rays for each pixel of the picture, where there are many edges.
constexpr double kMostRays = 3.0;

/// The pixels of `rows` around which light differs much, in 3x3 pixels.
std::vector<Pixel> pixels_at_edges(const PixelRect& rect, const SharedRows& rows,
                                   const std::vector<float>& seen) {
  const int width = rect.width(), height = rect.height(), above = rows.top;
  std::vector<float> brightness(seen.size() / 3);
  for (std::size_t p = 0; p < brightness.size(); ++p)
    brightness[p] = seen[3 * p] + seen[3 * p + 1] + seen[3 * p + 2];
  std::vector<double> sums;
  for (int y = rows.first - above; y < rows.end - above; ++y) {
    const auto begin = brightness.begin() + static_cast<std::ptrdiff_t>(y) * width;
    sums.push_back(std::accumulate(begin, begin + width, 0.0));
  }
  sums = rows.join(std::move(sums));
  const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / width / rows.height;
  const auto least = static_cast<float>(kLeastShare * mean);
  std::vector<Pixel> pixels;
  for (int y = rows.first - above; y < rows.end - above; ++y) {
    for (int x = 0; x < width; ++x) {
      float low = scene::kInfinity, high = 0.0f;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          const float b = brightness[rect.index(u + rect.x0, v + rect.y0)];
          low = std::min(low, b);
          high = std::max(high, b);
        }
      }
      if (high > kContrast * low && high - low > least) pixels.push_back({x + rect.x0, y + rect.y0});
    }
  }
  return pixels;
}

Color seen_by(const World& world, const CameraSample& sample, const Ray& ray, const Hit& hit) {
  if (!hit || world.catches(hit.instance))
    return world.background_apart ? Color(Color::Zero()) : world.environment.radiance(ray.direction);
  const RayCone& cone = sample.camera_ray.cone;
  return world.surfaces.at(hit, ray.direction, cone.width + cone.spread * hit.t, 0.5f).emission;
}

}  // namespace

void smooth_edges(const World& world, const Camera& camera, const FilterSampler& filter,
                  const RenderOptions& options, const PixelRect& rect, const SharedRows& rows, double spp,
                  std::vector<float>& seen) {
  const std::vector<Pixel> pixels = pixels_at_edges(rect, rows, seen);
  const std::vector<double> numbers = rows.join({static_cast<double>(pixels.size())});
  const double at_edges = std::accumulate(numbers.begin(), numbers.end(), 0.0);
  if (pixels.empty()) return;
  const double all = static_cast<double>(rect.width()) * rows.height;
  const int count = static_cast<int>(std::min<double>(kMostSamples, std::floor(kMostRays * all / at_edges)));
  if (count < kTimesMore * spp) return;
  RenderOptions more = options;
  more.seed = hash(options.seed ^ 0x65646765u);
  constexpr std::size_t kBlock = 64;
  tbb::parallel_for(std::size_t{0}, (pixels.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, pixels.size());
    std::vector<CameraSample> samples;
    std::vector<Ray> rays;
    for (std::size_t i = begin; i < end; ++i) {
      for (int s = 0; s < count; ++s) {
        samples.push_back(
            make_camera_sample({pixels[i], static_cast<std::uint32_t>(s)}, more, camera, filter));
        rays.push_back(samples.back().ray());
      }
    }
    std::vector<Hit> hits(rays.size());
    // Packets hold the rays of one pixel, so that a part of the picture has the same ones.
    for (std::size_t ray = 0; ray < rays.size(); ray += static_cast<std::size_t>(count)) {
      const auto size = static_cast<std::size_t>(count);
      world.accel.intersect(std::span(rays).subspan(ray, size), std::span(hits).subspan(ray, size), true);
    }
    for (std::size_t i = begin; i < end; ++i) {
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      for (int s = 0; s < count; ++s) {
        const std::size_t ray = (i - begin) * static_cast<std::size_t>(count) + static_cast<std::size_t>(s);
        sum += seen_by(world, samples[ray], rays[ray], hits[ray]).cast<double>();
      }
      const std::size_t p = rect.index(pixels[i].x, pixels[i].y);
      for (int c = 0; c < 3; ++c)
        seen[3 * p + static_cast<std::size_t>(c)] = static_cast<float>(sum[c] / count);
    }
  });
}

}  // namespace gatelight::renderer
