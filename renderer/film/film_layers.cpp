// The layers of a film: what its sums say, as a picture.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/film/film.h"
#include "renderer/machine/finite_float.h"
#include "renderer/settings/words.h"

namespace gatelight::renderer {
namespace {

/// Fills a layer by value(pixel, channel), for the pixels begin <= pixel < end.
template <class Range, class Value>
void fill(Layer& layer, const Range& all, Value value) {
  const std::size_t channels = layer.channels.size();
  layer.values.resize((all.end - all.begin) * channels);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(all.begin, all.end, 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t p = range.begin(); p < range.end(); ++p) {
                        for (std::size_t i = 0; i < channels; ++i)
                          layer.values[(p - all.begin) * channels + i] = finite_float(value(p, i));
                      }
                    });
}

/// The mean of so many, or 0.
double over(double sum, std::uint32_t count) {
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

Layer Film::layer(Aov aov, Range range) const {
  Layer layer;
  layer.name = word(aov);
  layer.full_precision =
      aov != Aov::albedo && aov != Aov::normal && aov != Aov::cache_answer && aov != Aov::nearest_node;
  const auto fill_with = [&](std::vector<std::string> channels, auto&& value) {
    layer.channels = std::move(channels);
    fill(layer, range, value);
  };
  // The means of first hits. The background counts as black where samples are counted, as in the beauty
  // layer, so edges stay soft.
  const auto fill_vector = [&](std::vector<std::string> channels, std::array<double, 3> First::*sum,
                               std::uint32_t First::*count) {
    fill_with(std::move(channels), [&, sum, count](std::size_t p, std::size_t i) {
      return over((first_[p].*sum)[i], first_[p].*count);
    });
  };
  const auto fill_number = [&](const char* channel, double First::*sum, std::uint32_t First::*count) {
    fill_with({channel},
              [&, sum, count](std::size_t p, std::size_t) { return over(first_[p].*sum, first_[p].*count); });
  };
  switch (aov) {
    case Aov::albedo:
      fill_vector({"R", "G", "B"}, &First::albedo, &First::count);
      break;
    case Aov::normal:
      fill_vector({"X", "Y", "Z"}, &First::normal, &First::count);
      break;
    case Aov::depth:
      fill_number("Z", &First::depth, &First::hits);
      break;
    case Aov::position:
      fill_vector({"X", "Y", "Z"}, &First::position, &First::hits);
      break;
    case Aov::primitive_id:
      fill_with({"id"}, [&](std::size_t p, std::size_t) { return first_[p].primitive; });
      break;
    case Aov::instance_id:
      fill_with({"id"}, [&](std::size_t p, std::size_t) { return first_[p].instance; });
      break;
    case Aov::cache_radiance:
      fill_vector({"R", "G", "B"}, &First::cache, &First::cached);
      break;
    case Aov::cache_answer:
      fill_vector({"R", "G", "B"}, &First::answer, &First::count);
      break;
    case Aov::nearest_node:
      fill_vector({"R", "G", "B"}, &First::node, &First::count);
      break;
    case Aov::cache_error:
      fill_number("error", &First::error, &First::asked);
      break;
    case Aov::training_count:
      fill_number("count", &First::training_count, &First::asked);
      break;
    case Aov::resolution:
      fill_number("R", &First::resolution, &First::asked);
      break;
    case Aov::alpha:
      fill_with({"A"}, [&](std::size_t p, std::size_t) { return over(alpha_[p], radiance_[p].taken); });
      break;
    case Aov::sample_count:
      fill_with({"count"}, [&](std::size_t p, std::size_t) { return radiance_[p].count; });
      break;
    case Aov::variance:
      fill_with({"R", "G", "B"},
                [&](std::size_t p, std::size_t i) { return variance_of_mean(radiance_[p], i); });
      break;
    case Aov::raw:
      fill_with({"R", "G", "B"}, [&](std::size_t p, std::size_t i) { return mean(radiance_[p], i); });
      break;
    case Aov::error:
      fill_with({"R", "G", "B"},
                [&](std::size_t p, std::size_t i) { return std::sqrt(variance_of_mean(radiance_[p], i)); });
      break;
    case Aov::denoising:
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
      fill(layer, range, [&](std::size_t p, std::size_t i) { return mean(radiance_[p], i); });
      break;
    case Plane::half_a:
    case Plane::half_b:
      fill(layer, range,
           [&](std::size_t p, std::size_t i) { return half_mean(p, plane == Plane::half_b, i); });
      break;
    case Plane::albedo:
    case Plane::normal:
      fill(layer, range, [&](std::size_t p, std::size_t i) {
        const auto& sum = plane == Plane::albedo ? guides_[p].albedo : guides_[p].normal;
        return over(static_cast<double>(sum[i]), radiance_[p].taken);
      });
      break;
    case Plane::alpha:
      fill(layer, range, [&](std::size_t p, std::size_t) { return over(alpha_[p], radiance_[p].taken); });
      break;
  }
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
    if (aov != Aov::denoising) picture.layers.push_back(layer(aov, range));
  }
  const std::size_t groups = contents_.light_groups.size();
  for (std::size_t g = 0; g < groups; ++g) {
    Layer light{
        .name = kLightLayer + contents_.light_groups[g], .channels = {"R", "G", "B"}, .full_precision = true};
    fill(light, range,
         [&](std::size_t p, std::size_t i) { return over(parts_[p * groups + g][i], radiance_[p].count); });
    picture.layers.push_back(std::move(light));
  }
  return picture;
}

}  // namespace gatelight::renderer
