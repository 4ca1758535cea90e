// The layers of a film, computed from its sums.

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "base/finite_float.h"
#include "renderer/film/film.h"

#include "base/parallel/loops.h"

namespace gatelight::renderer {
namespace {

/// Fills a layer by value(pixel, channel), for the pixels begin <= pixel < end.
template <class Range, class Value>
void fill(Layer& layer, const Range& all, Value value) {
  const std::size_t channels = layer.channels.size();
  layer.values.resize((all.end - all.begin) * channels);
  for_each_range(all.end - all.begin, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (std::size_t i = 0; i < channels; ++i)
        layer.values[p * channels + i] = finite_float(value(all.begin + p, i));
    }
  });
}

/// The mean of `count` values with this sum, or 0.
double over(double sum, std::uint32_t count) {
  return count > 0 ? sum / count : 0.0;
}

double channel_of(double number, std::size_t) {
  return number;
}

double channel_of(const std::array<double, 3>& vector, std::size_t i) {
  return vector[i];
}

}  // namespace

Layer Film::layer(Aov aov, Range range) const {
  const AovInfo& info = info_of(aov);
  Layer layer{.name = std::string(info.name), .channels = channels_of(info), .full_precision = !info.half};
  const auto fill_with = [&](auto&& value) { fill(layer, range, value); };
  const HugeBuffer<FirstHitSum>& first = sums_.first_hits;
  const HugeBuffer<RadianceSum>& radiance = sums_.radiance;
  for (const FirstHitMean& row : kFirstHitMeans) {
    if (row.aov != aov) continue;
    const auto fill_by = [&](auto sum) {
      fill_with([&](std::size_t p, std::size_t i) {
        return over(channel_of(first[p].*sum, i), first[p].*row.count);
      });
    };
    std::visit(fill_by, row.sum);
  }
  switch (aov) {
    case Aov::primitive_id:
      fill_with([&](std::size_t p, std::size_t) { return first[p].primitive; });
      break;
    case Aov::instance_id:
      fill_with([&](std::size_t p, std::size_t) { return first[p].instance; });
      break;
    case Aov::alpha:
      fill_with([&](std::size_t p, std::size_t) { return over(sums_.alpha[p], radiance[p].taken); });
      break;
    case Aov::sample_count:
      fill_with([&](std::size_t p, std::size_t) { return radiance[p].count; });
      break;
    case Aov::variance:
      fill_with([&](std::size_t p, std::size_t i) { return variance_of_mean(radiance[p], i); });
      break;
    case Aov::raw:
      fill_with([&](std::size_t p, std::size_t i) { return mean(radiance[p], i); });
      break;
    case Aov::error:
      fill_with([&](std::size_t p, std::size_t i) { return std::sqrt(variance_of_mean(radiance[p], i)); });
      break;
    default:
      break;
  }
  return layer;
}

std::vector<float> Film::plane(Plane plane, int first, int end) const {
  const Range range{rect_.index(rect_.x0, first), rect_.index(rect_.x0, end)};
  const bool single = plane == Plane::alpha;
  Layer layer{.channels = single ? std::vector<std::string>{"A"} : std::vector<std::string>{"R", "G", "B"}};
  switch (plane) {
    case Plane::mean:
      fill(layer, range, [&](std::size_t p, std::size_t i) { return mean(sums_.radiance[p], i); });
      break;
    case Plane::half_a:
    case Plane::half_b:
      fill(layer, range,
           [&](std::size_t p, std::size_t i) { return half_mean(p, plane == Plane::half_b, i); });
      break;
    case Plane::albedo:
    case Plane::normal:
      fill(layer, range, [&](std::size_t p, std::size_t i) {
        const auto& sum = plane == Plane::albedo ? sums_.guides[p].albedo : sums_.guides[p].normal;
        return over(static_cast<double>(sum[i]), sums_.radiance[p].taken);
      });
      break;
    case Plane::alpha:
      fill(layer, range,
           [&](std::size_t p, std::size_t) { return over(sums_.alpha[p], sums_.radiance[p].taken); });
      break;
  }
  return std::move(layer.values);
}

std::vector<float> Film::part(std::size_t number, int first, int end) const {
  const Range range{rect_.index(rect_.x0, first), rect_.index(rect_.x0, end)};
  Layer layer{.channels = {"R", "G", "B"}};
  const std::size_t parts = contents_.parts.size();
  fill(layer, range, [&](std::size_t p, std::size_t i) {
    return over(sums_.parts[p * parts + number][i], sums_.radiance[p].count);
  });
  return std::move(layer.values);
}

Picture Film::resolve(int first, int end) const {
  const auto begin_of = [&](int y) { return rect_.index(rect_.x0, y); };
  const Range range{begin_of(first), begin_of(end)};
  Picture picture{.width = rect_.width(),
                  .height = end - first,
                  .x0 = rect_.x0,
                  .y0 = first,
                  .full_width = full_width_,
                  .full_height = full_height_};
  picture.layers.push_back({.channels = {"R", "G", "B"}, .values = plane(Plane::mean, first, end)});
  for (const Aov aov : contents_.aovs) {
    const AovSource source = info_of(aov).source;
    if (source == AovSource::first_hit || source == AovSource::samples)
      picture.layers.push_back(layer(aov, range));
  }
  for (std::size_t number = 0; number < contents_.parts.size(); ++number) {
    picture.layers.push_back({.name = contents_.parts[number],
                              .channels = {"R", "G", "B"},
                              .values = part(number, first, end),
                              .full_precision = true});
  }
  return picture;
}

}  // namespace gatelight::renderer
