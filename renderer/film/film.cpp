#include "renderer/film/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace gatelight::renderer {

namespace {

bool from_first_hit(Aov aov) {
  constexpr Aov kOthers[] = {Aov::sample_count, Aov::variance, Aov::raw,
                             Aov::error,        Aov::alpha,    Aov::denoising};
  return !has(kOthers, aov);
}

template <class Number, class Vector>
void accumulate(std::array<Number, 3>& sum, const Vector& v) {
  for (int i = 0; i < 3; ++i) sum[static_cast<std::size_t>(i)] += static_cast<Number>(v[i]);
}

// Visits each member of a pixel in turn, for export and import.
template <class Radiance, class Take>
void each_of_radiance(Radiance& p, Take&& take) {
  for (auto* array : {&p.sum, &p.square}) {
    for (auto& value : *array) take.sum(value);
  }
  take.count(p.count);
  take.count(p.taken);
}

template <class Half, class Take>
void each_of_half(Half& p, Take&& take) {
  for (auto& value : p.sum) take.sum(value);
  take.count(p.count);
}

template <class First, class Take>
void each_of_first(First& p, Take&& take) {
  for (auto* array : {&p.albedo, &p.normal, &p.position, &p.answer, &p.node, &p.cache}) {
    for (auto& value : *array) take.sum(value);
  }
  for (auto* value : {&p.depth, &p.error, &p.training_count, &p.resolution}) take.sum(*value);
  for (auto* value : {&p.count, &p.asked, &p.hits, &p.cached}) take.count(*value);
  for (auto* value : {&p.instance, &p.primitive}) take.id(*value);
}

struct Exporter {
  std::vector<double>& sums;
  std::vector<std::uint32_t>& counts;
  std::vector<float>* ids = nullptr;
  void sum(double value) { sums.push_back(value); }
  void count(std::uint32_t value) { counts.push_back(value); }
  void id(float value) { ids->push_back(value); }
};

struct Importer {
  std::vector<double>::const_iterator sums;
  std::vector<std::uint32_t>::const_iterator counts;
  std::vector<float>::const_iterator ids;
  void sum(double& value) { value = *sums++; }
  void count(std::uint32_t& value) { value = *counts++; }
  void id(float& value) { value = *ids++; }
};

}  // namespace

FilmContents film_contents(const RenderOptions& options, std::vector<std::string> light_groups) {
  const bool denoised = options.denoise.denoiser != DenoiserKind::none;
  return {.aovs = options.aovs,
          .half = denoised,
          .guides = denoised || has(options.aovs, Aov::denoising),
          .alpha = options.background.apart() || has(options.aovs, Aov::alpha),
          .light_groups = std::move(light_groups)};
}

Film::Film(PixelRect rect, int full_width, int full_height, FilmContents contents)
    : rect_(rect), full_width_(full_width), full_height_(full_height), contents_(std::move(contents)) {
  const std::size_t pixels = static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height());
  const std::vector<Aov>& aovs = contents_.aovs;
  radiance_.resize(pixels);
  if (contents_.half) half_.resize(pixels);
  if (contents_.guides) guides_.resize(pixels);
  if (contents_.alpha) alpha_.resize(pixels);
  if (std::any_of(aovs.begin(), aovs.end(), from_first_hit)) first_.resize(pixels);
  parts_.resize(pixels * contents_.light_groups.size());
}

std::size_t Film::bytes_per_pixel(const FilmContents& contents) {
  const std::vector<Aov>& aovs = contents.aovs;
  const bool first = std::any_of(aovs.begin(), aovs.end(), from_first_hit);
  return sizeof(Radiance) + (contents.half ? sizeof(Half) : 0) + (contents.guides ? sizeof(Guide) : 0) +
         (contents.alpha ? sizeof(double) : 0) + (first ? sizeof(First) : 0) +
         contents.light_groups.size() * sizeof(std::array<double, 3>);
}

void Film::take(std::span<const Pixel> pixels, std::vector<PixelSample>& samples) {
  samples.clear();
  for (const Pixel& p : pixels) samples.push_back(take(p));
}

void Film::add(const PixelSample& sample, const Color& radiance) {
  const std::size_t pixel = at(sample.pixel);
  Radiance& p = radiance_[pixel];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto v = static_cast<double>(radiance[static_cast<Eigen::Index>(i)]);
    p.sum[i] += v;
    p.square[i] += v * v;
  }
  ++p.count;
  if (half_.empty() || !sample.in_first_half()) return;
  accumulate(half_[pixel].sum, radiance);
  ++half_[pixel].count;
}

void Film::add(const PixelSample& sample, const FirstHit& first) {
  const std::size_t pixel = at(sample.pixel);
  if (!guides_.empty() && first.guide.hit) {
    accumulate(guides_[pixel].albedo, first.guide.albedo);
    accumulate(guides_[pixel].normal, first.guide.normal);
  }
  if (!alpha_.empty()) alpha_[pixel] += static_cast<double>(first.alpha);
  if (!first_.empty()) add_first(first_[pixel], first);
}

void Film::add_first(First& p, const FirstHit& first) {
  if (first.guided && first.cache_radiance.isFinite().all()) {
    accumulate(p.cache, first.cache_radiance.matrix());
    ++p.cached;
  }
  if (p.count++ == 0 && first.hit) {
    p.instance = static_cast<float>(first.instance);
    p.primitive = static_cast<float>(first.primitive);
  }
  if (!first.hit) return;
  accumulate(p.albedo, first.albedo.matrix());
  accumulate(p.normal, first.normal);
  accumulate(p.position, first.position);
  p.depth += static_cast<double>(first.depth);
  ++p.hits;
  if (!first.asked) return;
  accumulate(p.answer, first.answer.matrix());
  accumulate(p.node, first.node.matrix());
  p.error += static_cast<double>(first.error);
  p.training_count += static_cast<double>(first.training_count);
  p.resolution += static_cast<double>(first.resolution);
  ++p.asked;
}

void Film::add_parts(const Pixel& p, std::span<const Color> parts, float scale) {
  const std::size_t first = at(p) * contents_.light_groups.size();
  for (std::size_t g = 0; g < parts.size(); ++g) {
    for (std::size_t i = 0; i < 3; ++i)
      parts_[first + g][i] +=
          static_cast<double>(parts[g][static_cast<Eigen::Index>(i)]) * static_cast<double>(scale);
  }
}

double Film::mean(const Radiance& p, std::size_t channel) {
  return p.count > 0 ? p.sum[channel] / p.count : 0.0;
}

double Film::half_mean(std::size_t pixel, bool second, std::size_t channel) const {
  const Radiance& all = radiance_[pixel];
  const Half& first = half_[pixel];
  const std::uint32_t count = second ? all.count - first.count : first.count;
  if (count == 0) return mean(all, channel);
  return (second ? all.sum[channel] - first.sum[channel] : first.sum[channel]) / count;
}

double Film::variance_of_mean(const Radiance& p, std::size_t channel) {
  if (p.count < 2) return 0.0;
  const double n = p.count, sum = p.sum[channel];
  return std::max(0.0, (p.square[channel] - sum * sum / n) / (n * (n - 1.0)));
}

double Film::samples_per_pixel() const {
  double sum = 0.0;
  for (const Radiance& p : radiance_) sum += p.count;
  return sum / static_cast<double>(radiance_.size());
}

float Film::faint(const Pixel& p) const {
  // Of the mean's largest channel. More saves little more time and costs noise (transport/README.md).
  constexpr double kShare = 0.3;
  constexpr std::uint32_t kFewest = 4;  // samples that tell something of the mean
  const Radiance& r = radiance_[at(p)];
  if (r.count < kFewest) return 0.0f;
  return static_cast<float>(kShare * *std::max_element(r.sum.begin(), r.sum.end()) / r.count);
}

void Film::pack(std::span<const Pixel> pixels, Packer& packer) const {
  const std::size_t groups = contents_.light_groups.size();
  for (const Pixel& pixel : pixels) {
    const std::size_t i = at(pixel);
    packer.add(radiance_[i]);
    if (!half_.empty()) packer.add(half_[i]);
    if (!guides_.empty()) packer.add(guides_[i]);
    if (!alpha_.empty()) packer.add(alpha_[i]);
    if (!first_.empty()) packer.add(first_[i]);
    packer.add_all(std::span(parts_).subspan(i * groups, groups));
  }
}

void Film::unpack(std::span<const Pixel> pixels, Unpacker& unpacker) {
  const std::size_t groups = contents_.light_groups.size();
  for (const Pixel& pixel : pixels) {
    const std::size_t i = at(pixel);
    radiance_[i] = unpacker.read<Radiance>();
    if (!half_.empty()) half_[i] = unpacker.read<Half>();
    if (!guides_.empty()) guides_[i] = unpacker.read<Guide>();
    if (!alpha_.empty()) alpha_[i] = unpacker.read<double>();
    if (!first_.empty()) first_[i] = unpacker.read<First>();
    unpacker.read_all(std::span(parts_).subspan(i * groups, groups));
  }
}

FilmState Film::export_state() const {
  FilmState state;
  state.radiance.reserve(radiance_.size() * 6);
  state.radiance_counts.reserve(radiance_.size() * 2);
  state.first.reserve(first_.size() * 22);
  state.first_counts.reserve(first_.size() * 4);
  state.first_ids.reserve(first_.size() * 2);
  Exporter radiance{state.radiance, state.radiance_counts};
  for (const Radiance& p : radiance_) each_of_radiance(p, radiance);
  Exporter half{state.half, state.half_counts};
  for (const Half& p : half_) each_of_half(p, half);
  for (const Guide& p : guides_) {
    for (const auto* sum : {&p.albedo, &p.normal})
      state.guides.insert(state.guides.end(), sum->begin(), sum->end());
  }
  state.alpha = alpha_;
  Exporter first{state.first, state.first_counts, &state.first_ids};
  for (const First& p : first_) each_of_first(p, first);
  for (const auto& sums_of : parts_) state.parts.insert(state.parts.end(), sums_of.begin(), sums_of.end());
  return state;
}

void Film::import_state(const FilmState& state) {
  assert(state.radiance_counts.size() == 2 * radiance_.size() && state.half_counts.size() == half_.size() &&
         state.guides.size() == 6 * guides_.size() && state.alpha.size() == alpha_.size() &&
         state.first_ids.size() == 2 * first_.size() && state.parts.size() == 3 * parts_.size());
  Importer radiance{state.radiance.begin(), state.radiance_counts.begin(), {}};
  for (Radiance& p : radiance_) each_of_radiance(p, radiance);
  Importer half{state.half.begin(), state.half_counts.begin(), {}};
  for (Half& p : half_) each_of_half(p, half);
  auto guide = state.guides.begin();
  for (Guide& p : guides_) {
    for (auto* sum : {&p.albedo, &p.normal}) {
      for (float& value : *sum) value = *guide++;
    }
  }
  alpha_ = state.alpha;
  Importer first{state.first.begin(), state.first_counts.begin(), state.first_ids.begin()};
  for (First& p : first_) each_of_first(p, first);
  for (std::size_t i = 0; i < state.parts.size(); ++i) parts_[i / 3][i % 3] = state.parts[i];
}

}  // namespace gatelight::renderer
