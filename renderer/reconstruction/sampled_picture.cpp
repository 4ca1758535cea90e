#include "renderer/reconstruction/sampled_picture.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/image_read.h"

namespace gatelight::renderer {
namespace {

const Layer& expect_layer(const Picture& picture, const char* name, std::size_t channels) {
  const Layer* const layer = picture.find(name);
  if (!layer)
    throw ImageError(fmt::format("has no layer '{}', expected the layers of --aov reconstruction", name));
  if (layer->channels.size() != channels) {
    throw ImageError(fmt::format("has {} channels in its layer '{}', expected {}", layer->channels.size(),
                                 name, channels));
  }
  return *layer;
}

std::vector<float> finite_values(const Picture& picture, const char* name, std::size_t channels) {
  const std::vector<float>& from = expect_layer(picture, name, channels).values;
  std::vector<float> values(from.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.size(), 65536),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        values[i] = std::isfinite(from[i]) ? from[i] : 0.0f;
                    });
  return values;
}

}  // namespace

SampledPicture sampled_picture(const Picture& picture) {
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
  }
  if (picture.find("seen-a")) {
    s.halves[0].seen = finite_values(picture, "seen-a", 3);
    s.halves[1].seen = finite_values(picture, "seen-b", 3);
    for (SampledPicture::Half& half : s.halves) {
      for (std::vector<float>* values : {&half.color, &half.cache}) {
        for (std::size_t i = 0; i < values->size(); ++i)
          (*values)[i] = std::max((*values)[i] - half.seen[i], 0.0f);
      }
    }
  }
  for (const char* name : {"half-a", "half-b"}) {
    const std::vector<float>& values = picture.find(name)->values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) s.counts[i / 3] = 0.0f;
    }
  }
  return s;
}

}  // namespace gatelight::renderer
