#include "renderer/film/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace gatelight::renderer {

namespace {

bool from_guide(Aov aov) {
  return aov == Aov::reconstruction || aov == Aov::cache_radiance || aov == Aov::alpha;
}

bool from_first_hit(Aov aov) {
  return !from_guide(aov) && aov != Aov::sample_count && aov != Aov::variance && aov != Aov::raw &&
         aov != Aov::error;
}

/// Reconstruction reads some of the other layers.
std::vector<Aov> with_what_they_need(std::span<const Aov> aovs) {
  std::vector<Aov> all(aovs.begin(), aovs.end());
  if (!has(aovs, Aov::reconstruction)) return all;
  if (!has(all, Aov::sample_count)) all.push_back(Aov::sample_count);
  return all;
}

void accumulate(std::array<double, 3>& sum, const Eigen::Vector3f& v) {
  for (int i = 0; i < 3; ++i) sum[static_cast<std::size_t>(i)] += static_cast<double>(v[i]);
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

template <class Guide, class Take>
void each_of_guide(Guide& p, Take&& take) {
  for (auto* array : {&p.albedo, &p.normal, &p.cache, &p.cache_half}) {
    for (auto& value : *array) take.sum(value);
  }
  for (auto* value : {&p.depth, &p.alpha, &p.alpha_half}) take.sum(*value);
  for (auto* value : {&p.count, &p.count_half, &p.hits, &p.cached, &p.cached_half, &p.behind})
    take.count(*value);
}

template <class First, class Take>
void each_of_first(First& p, Take&& take) {
  for (auto* array : {&p.albedo, &p.normal, &p.position, &p.answer, &p.node}) {
    for (auto& value : *array) take.sum(value);
  }
  for (auto* value : {&p.depth, &p.error, &p.training_count, &p.resolution}) take.sum(*value);
  for (auto* value : {&p.count, &p.asked, &p.hits}) take.count(*value);
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

Film::Film(PixelRect rect, int full_width, int full_height, std::span<const Aov> aovs,
           std::vector<std::string> light_groups)
    : rect_(rect),
      full_width_(full_width),
      full_height_(full_height),
      aovs_(with_what_they_need(aovs)),
      light_groups_(std::move(light_groups)) {
  const std::size_t pixels = static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height());
  radiance_.resize(pixels);
  if (has(aovs_, Aov::reconstruction)) {
    for (auto& half : halves_) half.resize(pixels);
    for (auto& half : seen_) half.resize(pixels);
  }
  if (std::any_of(aovs_.begin(), aovs_.end(), from_guide)) guides_.resize(pixels);
  if (std::any_of(aovs_.begin(), aovs_.end(), from_first_hit)) first_.resize(pixels);
  parts_.resize(pixels * light_groups_.size());
}

std::size_t Film::bytes_per_pixel(std::span<const Aov> aovs, std::size_t light_groups) {
  const bool guide = std::any_of(aovs.begin(), aovs.end(), from_guide);
  const bool first = std::any_of(aovs.begin(), aovs.end(), from_first_hit);
  const std::size_t sums = has(aovs, Aov::reconstruction) ? 3 : 1;
  return sums * sizeof(Radiance) + (sums > 1 ? 2 * sizeof(std::array<double, 3>) : 0) +
         (guide ? sizeof(Guide) : 0) + (first ? sizeof(First) : 0) +
         light_groups * sizeof(std::array<double, 3>);
}

PixelSample Film::take(const Pixel& p) {
  const std::size_t i = at(p);
  if (halves_[0].empty()) return {p, radiance_[i].taken++};
  return take(p, halves_[1][i].taken < halves_[0][i].taken ? 1 : 0);
}

PixelSample Film::take(const Pixel& p, std::size_t half) {
  const std::size_t i = at(p);
  ++radiance_[i].taken;
  return {p, 2 * halves_[half][i].taken++ + static_cast<std::uint32_t>(half)};
}

void Film::follow(SampleDensity density) {
  density_ = std::move(density);
  density_passes_ = 0;
}

void Film::take_pass(std::span<const Pixel> pixels, int ahead, std::vector<PixelSample>& samples) {
  samples.clear();
  const std::uint64_t pass = density_passes_ + static_cast<std::uint64_t>(ahead);
  for (const Pixel& p : pixels) {
    if (!density_) {
      samples.push_back(take(p));
      continue;
    }
    for (const std::size_t half : {std::size_t{0}, std::size_t{1}}) {
      for (std::uint32_t n = density_->count(p, half, pass); n > 0; --n) samples.push_back(take(p, half));
    }
  }
}

void Film::add(const PixelSample& sample, const Color& radiance, const Color& seen) {
  const std::size_t pixel = at(sample.pixel);
  const auto add_to = [&](Radiance& p, const Color& value) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double v = static_cast<double>(value[static_cast<Eigen::Index>(i)]);
      p.sum[i] += v;
      p.square[i] += v * v;
    }
    ++p.count;
  };
  if (!halves_[0].empty()) {
    add_to(halves_[sample.half()][pixel], radiance - seen);
    accumulate(seen_[sample.half()][pixel], seen.matrix());
  }
  add_to(radiance_[pixel], radiance);
}

void Film::add(const PixelSample& sample, const FirstHit& first) {
  const std::size_t pixel = at(sample.pixel);
  if (!guides_.empty()) add_guide(guides_[pixel], first, sample.half() == 0);
  if (!first_.empty()) add_first(first_[pixel], first);
}

void Film::add_guide(Guide& p, const FirstHit& first, bool first_half) {
  ++p.count;
  p.alpha += static_cast<double>(first.alpha);
  if (first_half) {
    ++p.count_half;
    p.alpha_half += static_cast<double>(first.alpha);
  }
  if (first.guided && first.cache_radiance.isFinite().all()) {
    ++p.cached;
    if (first.behind_guide) ++p.behind;
    if (first_half) {
      ++p.cached_half;
      accumulate(p.cache_half, first.cache_radiance.matrix());
    }
    accumulate(p.cache, first.cache_radiance.matrix());
  }
  if (first.guide.hit) {
    ++p.hits;
    accumulate(p.albedo, first.guide.albedo.matrix());
    accumulate(p.normal, first.guide.normal);
    p.depth += static_cast<double>(first.guide.depth);
  }
}

void Film::add_first(First& p, const FirstHit& first) {
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
  const std::size_t first = at(p) * light_groups_.size();
  for (std::size_t g = 0; g < parts.size(); ++g) {
    for (std::size_t i = 0; i < 3; ++i)
      parts_[first + g][i] +=
          static_cast<double>(parts[g][static_cast<Eigen::Index>(i)]) * static_cast<double>(scale);
  }
}

double Film::mean_of(const Radiance& p, std::size_t channel) {
  return p.count > 0 ? p.sum[channel] / p.count : 0.0;
}

double Film::seen_mean(std::size_t half, std::size_t pixel, std::size_t channel) const {
  const std::uint32_t count = halves_[half][pixel].count;
  return count > 0 ? seen_[half][pixel][channel] / count : 0.0;
}

bool Film::uneven(std::size_t pixel) const {
  if (halves_[0].empty()) return false;
  const std::uint32_t a = halves_[0][pixel].count, b = halves_[1][pixel].count;
  return a > 0 && b > 0 && a - b > 1;  // unsigned: also where b is greater
}

double Film::mean(std::size_t pixel, std::size_t channel) const {
  const Radiance& all = radiance_[pixel];
  if (!uneven(pixel)) return mean_of(all, channel);
  const std::uint32_t b = all.count / 2;
  const auto half = [&](std::size_t h) {
    return mean_of(halves_[h][pixel], channel) + seen_mean(h, pixel, channel);
  };
  return ((all.count - b) * half(0) + b * half(1)) / all.count;
}

double Film::variance(std::size_t pixel, std::size_t channel) const {
  const Radiance& all = radiance_[pixel];
  const double variance = variance_of_mean(all, channel);
  if (!uneven(pixel)) return variance;
  const std::uint32_t in_b = all.count / 2;
  const double n = all.count, b = in_b, a = n - b;
  return variance * (a * a / halves_[0][pixel].count + b * b / halves_[1][pixel].count) / n;
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
  for (const Pixel& pixel : pixels) {
    const std::size_t i = at(pixel);
    packer.add(radiance_[i]);
    for (const std::size_t h : {0u, 1u}) {
      if (halves_[h].empty()) continue;
      packer.add(halves_[h][i]);
      packer.add(seen_[h][i]);
    }
    if (!guides_.empty()) packer.add(guides_[i]);
    if (!first_.empty()) packer.add(first_[i]);
    const std::size_t groups = light_groups_.size();
    packer.add_all(std::span(parts_).subspan(i * groups, groups));
  }
}

void Film::unpack(std::span<const Pixel> pixels, Unpacker& unpacker) {
  for (const Pixel& pixel : pixels) {
    const std::size_t i = at(pixel);
    radiance_[i] = unpacker.read<Radiance>();
    for (const std::size_t h : {0u, 1u}) {
      if (halves_[h].empty()) continue;
      halves_[h][i] = unpacker.read<Radiance>();
      seen_[h][i] = unpacker.read<std::array<double, 3>>();
    }
    if (!guides_.empty()) guides_[i] = unpacker.read<Guide>();
    if (!first_.empty()) first_[i] = unpacker.read<First>();
    const std::size_t groups = light_groups_.size();
    unpacker.read_all(std::span(parts_).subspan(i * groups, groups));
  }
}

FilmState Film::export_state() const {
  FilmState state;
  const std::size_t sums = radiance_.size() + 2 * halves_[0].size();
  state.radiance.reserve(sums * 6 + 6 * seen_[0].size());
  state.radiance_counts.reserve(2 * sums);
  state.guides.reserve(guides_.size() * 15);
  state.guide_counts.reserve(guides_.size() * 6);
  state.first.reserve(first_.size() * 19);
  state.first_counts.reserve(first_.size() * 3);
  state.first_ids.reserve(first_.size() * 2);
  Exporter radiance{state.radiance, state.radiance_counts};
  for (const auto* all : {&radiance_, &halves_[0], &halves_[1]}) {
    for (const Radiance& p : *all) each_of_radiance(p, radiance);
  }
  for (const auto& half : seen_) {
    for (const auto& sums_of : half)
      state.radiance.insert(state.radiance.end(), sums_of.begin(), sums_of.end());
  }
  Exporter guides{state.guides, state.guide_counts};
  for (const Guide& p : guides_) each_of_guide(p, guides);
  Exporter first{state.first, state.first_counts, &state.first_ids};
  for (const First& p : first_) each_of_first(p, first);
  for (const auto& sums_of : parts_) state.parts.insert(state.parts.end(), sums_of.begin(), sums_of.end());
  if (density_) {
    for (const std::vector<float>& half : density_->values())
      state.density.insert(state.density.end(), half.begin(), half.end());
    state.density_passes = {density_passes_};
  }
  return state;
}

void Film::import_state(const FilmState& state) {
  assert(state.radiance_counts.size() == 2 * (radiance_.size() + 2 * halves_[0].size()) &&
         state.guide_counts.size() == 6 * guides_.size() && state.first_ids.size() == 2 * first_.size() &&
         state.parts.size() == 3 * parts_.size());
  Importer radiance{state.radiance.begin(), state.radiance_counts.begin(), {}};
  for (auto* sums : {&radiance_, &halves_[0], &halves_[1]}) {
    for (Radiance& p : *sums) each_of_radiance(p, radiance);
  }
  for (auto& half : seen_) {
    for (auto& sums_of : half) {
      for (double& value : sums_of) radiance.sum(value);
    }
  }
  Importer guides{state.guides.begin(), state.guide_counts.begin(), {}};
  for (Guide& p : guides_) each_of_guide(p, guides);
  Importer first{state.first.begin(), state.first_counts.begin(), state.first_ids.begin()};
  for (First& p : first_) each_of_first(p, first);
  for (std::size_t i = 0; i < state.parts.size(); ++i) parts_[i / 3][i % 3] = state.parts[i];
  density_.reset();
  if (state.density.empty()) return;
  const auto middle = state.density.begin() + static_cast<std::ptrdiff_t>(radiance_.size());
  density_ = SampleDensity::restore(rect_, {std::vector<float>(state.density.begin(), middle),
                                            std::vector<float>(middle, state.density.end())});
  density_passes_ = state.density_passes.front();
}

}  // namespace gatelight::renderer
