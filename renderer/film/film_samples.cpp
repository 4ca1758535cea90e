#include "renderer/film/film_samples.h"

#include <algorithm>
#include <tuple>

namespace gatelight::renderer {
namespace {

constexpr std::size_t kNonFiniteKept = 16;

/// One sequence on the screen needs to know how many samples it has. It does not help pictures with a cache
/// (renderer/sampling/README.md).
Sampler sampler_of(const PixelSample& sample, const RenderOptions& options) {
  const auto& [pixel, number] = sample;
  const bool spp_ends_it = options.spp > 0 && options.spp < kUnlimitedSpp &&
                           !(options.time_limit_seconds > 0.0) && !(options.max_error > 0.0);
  if (options.sampler == SamplerKind::screen && spp_ends_it && !uses_cache(options.integrator))
    return Sampler::of_screen(options.seed, morton(pixel), static_cast<std::uint32_t>(options.spp), number);
  return {options.sampler, options.seed, static_cast<std::uint32_t>(pixel.x),
          static_cast<std::uint32_t>(pixel.y), number};
}

}  // namespace

CameraSample make_camera_sample(const PixelSample& sample, const RenderOptions& options, const Camera& camera,
                                const FilterSampler& filter) {
  const auto& [pixel, number] = sample;
  const auto x = static_cast<std::uint32_t>(pixel.x);
  const auto y = static_cast<std::uint32_t>(pixel.y);
  CameraSample s;
  s.sampler = sampler_of(sample, options);
  s.seed = hash(hash(hash(hash(options.seed) + x) + y) + number);
  const Vec2 offset = filter.sample(s.sampler.get_2d(dimension::kFilm));
  s.camera_ray = camera_ray(camera, static_cast<float>(pixel.x) + 0.5f + offset.x(),
                            static_cast<float>(pixel.y) + 0.5f + offset.y(), s.sampler);
  if (camera.is_in_media()) s.start = camera.medium_of(s.camera_ray.ray);
  return s;
}

void make_camera_samples(std::span<const PixelSample> wanted, const Film& film, const RenderOptions& options,
                         const Camera& camera, const FilterSampler& filter,
                         std::vector<CameraSample>& samples) {
  samples.clear();
  for (const PixelSample& s : wanted) {
    samples.push_back(make_camera_sample(s, options, camera, filter));
    samples.back().contribution_threshold = film.contribution_threshold(s.pixel);
  }
}

void SampleCounts::add(const SampleCounts& other) {
  nonfinite += other.nonfinite;
  clamped += other.clamped;
  located.insert(located.end(), other.located.begin(), other.located.end());
}

void keep_first(std::vector<NonFiniteSample>& samples) {
  std::sort(samples.begin(), samples.end(), [](const NonFiniteSample& a, const NonFiniteSample& b) {
    return std::tie(a.y, a.x, a.sample) < std::tie(b.y, b.x, b.sample);
  });
  if (samples.size() > kNonFiniteKept) samples.resize(kNonFiniteKept);
}

void add_to_film(std::span<const PixelSample> samples, const RenderOptions& options,
                 std::span<const SampleResult> results, std::span<const FirstHit> first_hits, Film& film,
                 SampleCounts& counts, std::span<const Color> parts) {
  const std::size_t count = parts.empty() ? 0 : film.parts().size();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Color radiance = results[i].radiance;
    if (!first_hits.empty()) film.add(samples[i], first_hits[i]);
    if (!radiance.isFinite().all()) {
      ++counts.nonfinite;
      const auto& [pixel, number] = samples[i];
      counts.located.push_back({pixel.x, pixel.y, number, options.seed});
      if (counts.located.size() > 16 * kNonFiniteKept) keep_first(counts.located);
      continue;
    }
    float scale = 1.0f;
    if (options.clamp > 0.0f) {
      const float l = luminance(radiance);
      if (l > options.clamp) {
        scale = options.clamp / l;
        radiance *= scale;
        ++counts.clamped;
      }
    }
    film.add(samples[i], radiance);
    if (count > 0) film.add_parts(samples[i].pixel, parts.subspan(i * count, count), scale);
  }
}

}  // namespace gatelight::renderer
