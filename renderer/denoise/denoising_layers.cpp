#include "renderer/denoise/denoising_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>

#include "base/errors.h"
#include "renderer/image/color_channels.h"

namespace gatelight::renderer {
namespace {

constexpr const char* kColor = "denoising-color";
constexpr const char* kAlbedo = "denoising-albedo";
constexpr const char* kNormal = "denoising-normal";
constexpr const char* kAlpha = "denoising-alpha";
constexpr int kMaxFactor = 2;

std::size_t size(int x) {
  return static_cast<std::size_t>(x);
}

std::string name_of(const char* what, int factor, int column, int row) {
  return factor == 1 ? what : fmt::format("{}-{}{}", what, column, row);
}

/// Visits the places of one pixel of each factor x factor: in the picture, and in the samples.
template <class Visit>
void each_place(int width, int height, int factor, int column, int row, Visit visit) {
  std::size_t at = 0;
  for (int y = row; y < height; y += factor) {
    for (int x = column; x < width; x += factor) visit(at++, size(y) * size(width) + size(x));
  }
}

const Layer& layer_of(const Picture& picture, const std::string& name) {
  if (const Layer* const layer = picture.find(name)) return *layer;
  throw InputError(fmt::format("has no layer '{}'", name));
}

/// Some channels of each pixel; what is not finite is 0.
template <std::size_t channels>
std::vector<float> values_of(const Layer& layer, const std::array<std::size_t, channels>& index) {
  const std::size_t count = layer.channels.size(), pixels = layer.values.size() / count;
  std::vector<float> values;
  values.reserve(channels * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (const std::size_t c : index) {
      const float value = layer.values[i * count + c];
      values.push_back(std::isfinite(value) ? value : 0.0f);
    }
  }
  return values;
}

/// A plane of samples whose layers add_denoising_layers() wrote.
template <std::size_t channels>
std::vector<float> join_layers(const Picture& picture, const Samples& samples, const char* what) {
  std::vector<float> plane(size(samples.width) * size(samples.height) * channels);
  std::array<std::size_t, channels> index{};
  std::iota(index.begin(), index.end(), std::size_t{0});
  for (int row = 0; row < samples.factor; ++row) {
    for (int column = 0; column < samples.factor; ++column) {
      const Layer& layer = layer_of(picture, name_of(what, samples.factor, column, row));
      if (layer.channels.size() != channels) {
        throw InputError(fmt::format("has {} channels in its layer '{}', expected {}", layer.channels.size(),
                                     layer.name, channels));
      }
      const std::vector<float> values = values_of(layer, index);
      each_place(samples.width, samples.height, samples.factor, column, row,
                 [&](std::size_t from, std::size_t to) {
                   std::copy_n(&values[from * channels], channels, &plane[to * channels]);
                 });
    }
  }
  return plane;
}

/// The network for clean guides needs both of them. In place of one that is missing it gets a plane without
/// edges (README.md).
void complete_guides(Samples& samples) {
  if (samples.albedo.empty() == samples.normal.empty()) return;
  if (samples.albedo.empty()) samples.albedo.assign(samples.normal.size(), 1.0f);
  if (!samples.normal.empty()) return;
  samples.normal.assign(samples.albedo.size(), 0.0f);
  for (std::size_t i = 2; i < samples.normal.size(); i += 3) samples.normal[i] = 1.0f;
}

/// Metadata: NoisyPicture::noisy_guides of samples of this size, as x0,y0,x1,y1/WIDTHxHEIGHT.
constexpr const char* kNoisyGuides = "noisy-guides";

std::string text_of(const PixelRect& r, int width, int height) {
  return fmt::format("{},{},{},{}/{}x{}", r.x0, r.y0, r.x1, r.y1, width, height);
}

/// Of samples that are as they were written; else nothing.
std::optional<PixelRect> noisy_guides_of(const Picture& picture, int width, int height) {
  const auto found = picture.metadata.find(kNoisyGuides);
  if (found == picture.metadata.end()) return {};
  PixelRect r;
  if (std::sscanf(found->second.c_str(), "%d,%d,%d,%d", &r.x0, &r.y0, &r.x1, &r.y1) != 4) return {};
  const bool inside =
      0 <= r.x0 && r.x0 <= r.x1 && r.x1 <= width && 0 <= r.y0 && r.y0 <= r.y1 && r.y1 <= height;
  if (!inside || text_of(r, width, height) != found->second) return {};
  return r;
}

/// The size of the samples over that of the picture; 0: there are none.
int factor_of(const Picture& picture) {
  for (int factor = 1; factor <= kMaxFactor; ++factor) {
    if (picture.find(name_of(kColor, factor, 0, 0))) return factor;
  }
  return 0;
}

Samples own_samples(const Picture& picture, const LayersToDenoise& layers) {
  const int factor = factor_of(picture);
  Samples samples{factor, factor * picture.width, factor * picture.height};
  samples.color = join_layers<3>(picture, samples, kColor);
  if (layers.albedo) samples.albedo = join_layers<3>(picture, samples, kAlbedo);
  if (layers.normal) samples.normal = join_layers<3>(picture, samples, kNormal);
  if (picture.find(name_of(kAlpha, factor, 0, 0))) samples.alpha = join_layers<1>(picture, samples, kAlpha);
  complete_guides(samples);
  samples.noisy_guides = noisy_guides_of(picture, samples.width, samples.height);
  return samples;
}

ReadRows rows_of(const std::vector<float>& plane, int width, std::size_t channels = 3) {
  if (plane.empty()) return {};
  return [&plane, width, channels](int first, int end) {
    const auto at = [&](int y) {
      return plane.begin() + static_cast<std::ptrdiff_t>(channels * size(y) * size(width));
    };
    return std::vector<float>(at(first), at(end));
  };
}

}  // namespace

void add_denoising_layers(Picture& picture, const NoisyPicture& samples, int factor) {
  const auto add = [&](const char* what, const ReadRows& read, const std::vector<std::string>& channels) {
    if (!read) return;
    const std::vector<float> values = read(0, samples.height);
    const std::size_t count = channels.size();
    for (int row = 0; row < factor; ++row) {
      for (int column = 0; column < factor; ++column) {
        Layer layer{.name = name_of(what, factor, column, row), .channels = channels, .full_precision = true};
        layer.values.resize(values.size() / size(factor * factor));
        each_place(samples.width, samples.height, factor, column, row, [&](std::size_t to, std::size_t from) {
          std::copy_n(&values[from * count], count, &layer.values[to * count]);
        });
        picture.layers.push_back(std::move(layer));
      }
    }
  };
  add(kColor, samples.color, {"R", "G", "B"});
  add(kAlbedo, samples.albedo, {"R", "G", "B"});
  add(kNormal, samples.normal, {"X", "Y", "Z"});
  add(kAlpha, samples.alpha, {"A"});
  if (samples.noisy_guides)
    picture.metadata[kNoisyGuides] = text_of(*samples.noisy_guides, samples.width, samples.height);
}

bool is_denoising_layer(const std::string& name) {
  constexpr const char* kOwn[] = {kColor, kAlbedo, kNormal, kAlpha};
  return std::any_of(std::begin(kOwn), std::end(kOwn),
                     [&](const char* own) { return name.starts_with(own); });
}

NoisyPicture Samples::noisy() const {
  return {width,
          height,
          rows_of(color, width),
          rows_of(albedo, width),
          rows_of(normal, width),
          rows_of(alpha, width, 1),
          noisy_guides};
}

bool has_denoising_layers(const Picture& picture) {
  return factor_of(picture) > 0;
}

LayersToDenoise own_layers(const Picture& picture) {
  LayersToDenoise layers{.own = true, .color = kColor, .result = picture.layers.front().name};
  layers.albedo = kAlbedo;
  layers.normal = kNormal;
  return layers;
}

Samples samples_of(const Picture& picture, const LayersToDenoise& layers) {
  if (layers.own) return own_samples(picture, layers);
  Samples samples{1, picture.width, picture.height};
  const Layer& color = layer_of(picture, layers.color);
  samples.color = values_of(color, color_channels(color).value());
  if (layers.albedo) {
    const Layer& albedo = layer_of(picture, *layers.albedo);
    samples.albedo = values_of(albedo, color_channels(albedo).value());
  }
  if (layers.normal) {
    const Layer& normal = layer_of(picture, *layers.normal);
    samples.normal = values_of(normal, vector_channels(normal).value());
  }
  complete_guides(samples);
  return samples;
}

}  // namespace gatelight::renderer
