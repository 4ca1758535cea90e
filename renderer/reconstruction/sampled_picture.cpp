#include "renderer/reconstruction/sampled_picture.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/image_read.h"

namespace gatelight::renderer {
namespace {

std::vector<float>& expect_layer(Picture& picture, const char* name, std::size_t channels) {
  const auto layer = std::find_if(picture.layers.begin(), picture.layers.end(),
                                  [&](const Layer& l) { return l.name == name; });
  if (layer == picture.layers.end())
    throw ImageError(fmt::format("has no layer '{}', expected the layers of --aov reconstruction", name));
  if (layer->channels.size() != channels) {
    throw ImageError(fmt::format("has {} channels in its layer '{}', expected {}", layer->channels.size(),
                                 name, channels));
  }
  return layer->values;
}

template <class Function>
void for_each(std::size_t count, Function function) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 65536),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) function(i);
                    });
}

std::vector<float> finite_values(Picture& picture, const char* name, std::size_t channels) {
  std::vector<float> values = std::move(expect_layer(picture, name, channels));
  for_each(values.size(), [&](std::size_t i) {
    if (!std::isfinite(values[i])) values[i] = 0.0f;
  });
  return values;
}

/// No samples where a colour is not finite.
void drop_nonfinite(Picture& picture) {
  const std::vector<float>&a = expect_layer(picture, "half-a", 3), &b = expect_layer(picture, "half-b", 3);
  std::vector<float>& counts = expect_layer(picture, "samples", 1);
  for_each(counts.size(), [&](std::size_t p) {
    for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) {
      if (!std::isfinite(a[i]) || !std::isfinite(b[i])) counts[p] = 0.0f;
    }
  });
}

}  // namespace

SampledPicture take_samples(Picture& picture) {
  drop_nonfinite(picture);
  SampledPicture s{.width = picture.width,
                   .height = picture.height,
                   .halves = {{finite_values(picture, "half-a", 3), finite_values(picture, "variance-a", 3)},
                              {finite_values(picture, "half-b", 3), finite_values(picture, "variance-b", 3)}},
                   .counts = finite_values(picture, "samples", 1),
                   .coverage = finite_values(picture, "coverage", 1),
                   .albedo = finite_values(picture, "guide-albedo", 3),
                   .normal = finite_values(picture, "guide-normal", 3),
                   .depth = finite_values(picture, "guide-depth", 1)};
  if (picture.find("cache-a")) {
    s.halves[0].cache = finite_values(picture, "cache-a", 3);
    s.halves[1].cache = finite_values(picture, "cache-b", 3);
    if (picture.find("cache-behind")) s.behind = finite_values(picture, "cache-behind", 1);
  }
  if (picture.find("seen-a")) {
    s.halves[0].seen = finite_values(picture, "seen-a", 3);
    s.halves[1].seen = finite_values(picture, "seen-b", 3);
    for (SampledPicture::Half& half : s.halves) {
      for (std::vector<float>* values : {&half.color, &half.cache}) {
        for_each(values->size(),
                 [&](std::size_t i) { (*values)[i] = std::max((*values)[i] - half.seen[i], 0.0f); });
      }
    }
  }
  return s;
}

}  // namespace gatelight::renderer
