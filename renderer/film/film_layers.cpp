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
  layer.name = aov == Aov::reconstruction ? "coverage" : word(aov);
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
      fill_with({"R", "G", "B"},
                [&](std::size_t p, std::size_t i) { return over(guides_[p].cache[i], guides_[p].cached); });
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
      fill_with({"A"}, [&](std::size_t p, std::size_t) { return over(guides_[p].alpha, guides_[p].count); });
      break;
    case Aov::sample_count:
      fill_with({"count"}, [&](std::size_t p, std::size_t) { return radiance_[p].count; });
      break;
    case Aov::variance:
      fill_with({"R", "G", "B"}, [&](std::size_t p, std::size_t i) { return variance(p, i); });
      break;
    case Aov::raw:
      fill_with({"R", "G", "B"}, [&](std::size_t p, std::size_t i) { return mean(p, i); });
      break;
    case Aov::error:
      fill_with({"R", "G", "B"}, [&](std::size_t p, std::size_t i) { return std::sqrt(variance(p, i)); });
      break;
    case Aov::reconstruction:
      fill_with({"coverage"},
                [&](std::size_t p, std::size_t) { return over(guides_[p].hits, guides_[p].count); });
      break;
  }
  return layer;
}

void Film::add_guides(std::vector<Layer>& layers, Range range) const {
  Layer albedo{.name = "guide-albedo", .channels = {"R", "G", "B"}};
  fill(albedo, range,
       [&](std::size_t p, std::size_t i) { return over(guides_[p].albedo[i], guides_[p].count); });
  Layer normal{.name = "guide-normal", .channels = {"X", "Y", "Z"}};
  fill(normal, range,
       [&](std::size_t p, std::size_t i) { return over(guides_[p].normal[i], guides_[p].count); });
  Layer depth{.name = "guide-depth", .channels = {"Z"}, .full_precision = true};
  fill(depth, range, [&](std::size_t p, std::size_t) { return over(guides_[p].depth, guides_[p].hits); });
  if (has(aovs_, Aov::cache_radiance)) {
    Layer behind{.name = "cache-behind", .channels = {"share"}};
    fill(behind, range,
         [&](std::size_t p, std::size_t) { return over(guides_[p].behind, guides_[p].cached); });
    layers.push_back(std::move(behind));
  }
  for (Layer* layer : {&albedo, &normal, &depth}) layers.push_back(std::move(*layer));
}

void Film::add_halves(std::vector<Layer>& layers, Range range) const {
  const bool of_cache = has(aovs_, Aov::cache_radiance), of_alpha = has(aovs_, Aov::alpha);
  for (const std::size_t h : {0u, 1u}) {
    const auto layer_of = [&](const char* what, std::vector<std::string> channels = {"R", "G", "B"}) {
      const char half[] = {static_cast<char>('a' + h), '\0'};
      return Layer{.name = std::string(what) + half, .channels = std::move(channels), .full_precision = true};
    };
    Layer color = layer_of("half-"), variance = layer_of("variance-");
    fill(color, range,
         [&](std::size_t p, std::size_t i) { return mean_of(halves_[h][p], i) + seen_mean(h, p, i); });
    Layer seen = layer_of("seen-");
    fill(seen, range, [&](std::size_t p, std::size_t i) { return seen_mean(h, p, i); });
    fill(variance, range, [&](std::size_t p, std::size_t i) {
      const Radiance &half = halves_[h][p], &all = radiance_[p];
      // A single sample does not tell how it varies; all of the pixel's do.
      return half.count == 1 ? all.count * variance_of_mean(all, i) : variance_of_mean(half, i);
    });
    layers.push_back(std::move(color));
    layers.push_back(std::move(variance));
    layers.push_back(std::move(seen));
    if (of_alpha) {
      Layer alpha = layer_of("alpha-", {"A"});
      fill(alpha, range, [&](std::size_t p, std::size_t) {
        const Guide& f = guides_[p];
        const std::uint32_t in_b = f.count - f.count_half, n = h == 0 ? f.count_half : in_b;
        // A half without samples has the mean of all.
        if (n == 0) return f.count > 0 ? f.alpha / f.count : 0.0;
        return (h == 0 ? f.alpha_half : f.alpha - f.alpha_half) / n;
      });
      layers.push_back(std::move(alpha));
    }
    if (!of_cache) continue;
    Layer cache = layer_of("cache-");
    fill(cache, range, [&](std::size_t p, std::size_t i) {
      const Guide& guide = guides_[p];
      const std::uint32_t of_a = guide.cached_half, of_b = guide.cached - guide.cached_half;
      // A single sample stands for both halves.
      const bool second = of_b > 0 && (h == 1 || of_a == 0);
      const double sum = second ? guide.cache[i] - guide.cache_half[i] : guide.cache_half[i];
      return sum / std::max(second ? of_b : of_a, 1u);
    });
    layers.push_back(std::move(cache));
  }
}

// A group's share of the pixel's sum, times the mean: the layers add up to the mean also where that is not
// the sum over the number of samples (uneven halves).
void Film::add_light_groups(std::vector<Layer>& layers, Range pixels) const {
  const std::size_t groups = light_groups_.size(), first = layers.size();
  for (const std::string& name : light_groups_) {
    layers.push_back({.name = kLightLayer + name, .channels = {"R", "G", "B"}, .full_precision = true});
    layers.back().values.resize(3 * (pixels.end - pixels.begin));
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(pixels.begin, pixels.end, 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = 3 * range.begin(); i < 3 * range.end(); ++i) {
                        const std::size_t p = i / 3, channel = i % 3;
                        double all = 0.0;
                        for (std::size_t g = 0; g < groups; ++g) all += parts_[p * groups + g][channel];
                        const double mean_of_all = mean(p, channel);
                        for (std::size_t g = 0; g < groups && all != 0.0; ++g)
                          layers[first + g].values[i - 3 * pixels.begin] =
                              finite_float(mean_of_all * (parts_[p * groups + g][channel] / all));
                      }
                    });
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
  Layer beauty{.channels = {"R", "G", "B"}};
  fill(beauty, range, [&](std::size_t p, std::size_t i) { return mean(p, i); });
  picture.layers.push_back(std::move(beauty));
  for (const Aov aov : aovs_) picture.layers.push_back(layer(aov, range));
  add_light_groups(picture.layers, range);
  if (halves_[0].empty()) return picture;
  add_guides(picture.layers, range);
  add_halves(picture.layers, range);
  return picture;
}

}  // namespace gatelight::renderer
