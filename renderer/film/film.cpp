#include "renderer/film/film.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <type_traits>
#include <utility>

#include "base/parallel/loops.h"
#include "renderer/settings/light_group_options.h"

namespace gatelight::renderer {

namespace {

bool from_first_hit(Aov aov) {
  return info_of(aov).source == AovSource::first_hit;
}

FilmSums empty_sums(const FilmContents& contents, std::size_t pixels) {
  const std::vector<Aov>& aovs = contents.aovs;
  FilmSums sums;
  const auto keep = [](auto& plane, std::size_t size) { plane = std::decay_t<decltype(plane)>(size); };
  keep(sums.radiance, pixels);
  if (contents.half) keep(sums.half, pixels);
  if (contents.guides) keep(sums.guides, pixels);
  if (contents.alpha) keep(sums.alpha, pixels);
  if (std::any_of(aovs.begin(), aovs.end(), from_first_hit)) {
    keep(sums.first_hits, pixels);
    for_each_range(pixels, 4096, [&](std::size_t begin, std::size_t end) {
      std::fill(sums.first_hits.begin() + begin, sums.first_hits.begin() + end, FirstHitSum());
    });
  }
  if (!contents.parts.empty()) keep(sums.parts, pixels * contents.parts.size());
  return sums;
}

}  // namespace

FilmContents film_contents(const RenderOptions& options, const std::vector<std::string>& light_groups) {
  const bool denoised = options.denoise.denoiser != DenoiserKind::none;
  std::vector<std::string> parts;
  for (const std::string& group : light_groups) parts.push_back(kLightLayer + group);
  for (const Aov pass : passes_among(options.aovs)) parts.emplace_back(info_of(pass).name);
  return {.aovs = options.aovs,
          .half = denoised,
          .guides = denoised || has(options.aovs, Aov::denoising),
          .alpha = options.background.is_separate() || has(options.aovs, Aov::alpha),
          .parts = std::move(parts)};
}

Film::Film(PixelRect rect, int full_width, int full_height, FilmContents contents)
    : rect_(rect),
      full_width_(full_width),
      full_height_(full_height),
      contents_(std::move(contents)),
      sums_(empty_sums(contents_,
                       static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height()))) {}

std::size_t Film::bytes_per_pixel(const FilmContents& contents) {
  return empty_sums(contents, 1).bytes();
}

void Film::take(std::span<const Pixel> pixels, std::vector<PixelSample>& samples) {
  samples.clear();
  for (const Pixel& p : pixels) samples.push_back(take(p));
}

void Film::add(const PixelSample& sample, const Color& radiance) {
  const std::size_t pixel = at(sample.pixel);
  RadianceSum& p = sums_.radiance[pixel];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto v = static_cast<double>(radiance[static_cast<Eigen::Index>(i)]);
    p.sum[i] += v;
    p.square[i] += v * v;
  }
  ++p.count;
  if (sums_.half.empty() || !sample.in_first_half()) return;
  accumulate(sums_.half[pixel].sum, radiance);
  ++sums_.half[pixel].count;
}

void Film::add(const PixelSample& sample, const FirstHit& first) {
  const std::size_t pixel = at(sample.pixel);
  if (!sums_.guides.empty() && first.guide.hit) {
    accumulate(sums_.guides[pixel].albedo, first.guide.albedo);
    accumulate(sums_.guides[pixel].normal, first.guide.normal);
  }
  if (!sums_.alpha.empty()) sums_.alpha[pixel] += static_cast<double>(first.alpha);
  if (!sums_.first_hits.empty()) sums_.first_hits[pixel].add(first);
}

void Film::add_parts(const Pixel& p, std::span<const Color> parts, float scale) {
  const std::size_t first = at(p) * contents_.parts.size();
  for (std::size_t g = 0; g < parts.size(); ++g) {
    for (std::size_t i = 0; i < 3; ++i)
      sums_.parts[first + g][i] +=
          static_cast<double>(parts[g][static_cast<Eigen::Index>(i)]) * static_cast<double>(scale);
  }
}

double Film::mean(const RadianceSum& p, std::size_t channel) {
  return p.count > 0 ? p.sum[channel] / p.count : 0.0;
}

double Film::half_mean(std::size_t pixel, bool second, std::size_t channel) const {
  const RadianceSum& all = sums_.radiance[pixel];
  const HalfSum& first = sums_.half[pixel];
  const std::uint64_t count = second ? all.count - first.count : first.count;
  if (count == 0) return mean(all, channel);
  return (second ? all.sum[channel] - first.sum[channel] : first.sum[channel]) / count;
}

double Film::variance_of_mean(const RadianceSum& p, std::size_t channel) {
  if (p.count < 2) return 0.0;
  const double n = p.count, sum = p.sum[channel];
  return std::max(0.0, (p.square[channel] - sum * sum / n) / (n * (n - 1.0)));
}

double Film::samples_per_pixel() const {
  std::atomic<std::uint64_t> sum = 0;
  for_each_range(sums_.radiance.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    std::uint64_t part = 0;
    for (std::size_t i = begin; i < end; ++i) part += sums_.radiance[i].count;
    sum += part;
  });
  return static_cast<double>(sum) / static_cast<double>(sums_.radiance.size());
}

float Film::contribution_threshold(const Pixel& p) const {
  // Share of the mean's largest channel. More saves little more time and adds noise (transport/README.md).
  constexpr double kShare = 0.3;
  constexpr std::uint32_t kFewest = 4;  // least number of samples for a useful mean
  const RadianceSum& r = sums_.radiance[at(p)];
  if (r.count < kFewest) return 0.0f;
  return static_cast<float>(kShare * *std::max_element(r.sum.begin(), r.sum.end()) / r.count);
}

void Film::set_sums(FilmSums sums) {
  assert(sums.radiance.size() == sums_.radiance.size() && sums.bytes() == sums_.bytes());
  sums_ = std::move(sums);
}

void Film::pack(std::span<const Pixel> pixels, Packer& packer) const {
  for (const Pixel& pixel : pixels) sums_.pack(at(pixel), packer);
}

void Film::unpack(std::span<const Pixel> pixels, Unpacker& unpacker) {
  for (const Pixel& pixel : pixels) sums_.unpack(at(pixel), unpacker);
}

}  // namespace gatelight::renderer
