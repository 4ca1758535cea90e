#include "renderer/denoise/denoising_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "renderer/image/image_read.h"
#include "renderer/image/short_name.h"

namespace gatelight::renderer {
namespace {

constexpr const char* kColor = "denoising-color";
constexpr const char* kAlbedo = "denoising-albedo";
constexpr const char* kNormal = "denoising-normal";
constexpr const char* kAlpha = "denoising-alpha";
constexpr int kMostFactor = 2;

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

/// The first of the names that the picture has.
const Layer* find_layer(const Picture& picture, std::initializer_list<const char*> names) {
  for (const char* const name : names) {
    for (const Layer& layer : picture.layers) {
      if (short_name(layer.name) == name) return &layer;
    }
  }
  return nullptr;
}

const Layer* named_layer(const Picture& picture, const std::string& name) {
  if (const Layer* const layer = picture.find(name)) return layer;
  throw InputError(fmt::format("has no layer '{}'", name));
}

std::vector<float> values_of(const Layer& layer, std::size_t channels) {
  const std::size_t has = layer.channels.size();
  // A fourth channel is alpha.
  if (has != channels && !(channels == 3 && has == 4)) {
    throw InputError(
        fmt::format("has {} channels in its layer '{}', expected {}", has, layer.name, channels));
  }
  std::vector<float> values;
  if (has == channels) {
    values = layer.values;
  } else {
    for (std::size_t i = 0; i < layer.values.size(); i += has)
      values.insert(values.end(), &layer.values[i], &layer.values[i] + channels);
  }
  for (float& value : values)
    if (!std::isfinite(value)) value = 0.0f;
  return values;
}

/// A plane of samples whose layers add_denoising_layers() wrote.
std::vector<float> join_layers(const Picture& picture, const Samples& samples, const char* what,
                               std::size_t channels) {
  std::vector<float> plane(size(samples.width) * size(samples.height) * channels);
  for (int row = 0; row < samples.factor; ++row) {
    for (int column = 0; column < samples.factor; ++column) {
      const std::string name = name_of(what, samples.factor, column, row);
      const std::vector<float> values = values_of(*named_layer(picture, name), channels);
      each_place(samples.width, samples.height, samples.factor, column, row,
                 [&](std::size_t from, std::size_t to) {
                   std::copy_n(&values[from * channels], channels, &plane[to * channels]);
                 });
    }
  }
  return plane;
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
}

bool is_denoising_layer(const std::string& name) {
  return name.starts_with("denoising-");
}

NoisyPicture Samples::noisy() const {
  return {width,
          height,
          rows_of(color, width),
          rows_of(albedo, width),
          rows_of(normal, width),
          rows_of(alpha, width, 1)};
}

Samples samples_of(const Picture& picture, const LayerNames& names) {
  const bool named = !(names.color.empty() && names.albedo.empty() && names.normal.empty());
  for (int factor = 1; factor <= kMostFactor && !named; ++factor) {
    if (!picture.find(name_of(kColor, factor, 0, 0))) continue;
    Samples samples{factor, factor * picture.width, factor * picture.height};
    samples.color = join_layers(picture, samples, kColor, 3);
    samples.albedo = join_layers(picture, samples, kAlbedo, 3);
    samples.normal = join_layers(picture, samples, kNormal, 3);
    if (picture.find(name_of(kAlpha, factor, 0, 0))) samples.alpha = join_layers(picture, samples, kAlpha, 1);
    return samples;
  }
  const auto find = [&](const std::string& name, std::initializer_list<const char*> usual) {
    return name.empty() ? find_layer(picture, usual) : named_layer(picture, name);
  };
  const Layer* color = find(names.color, {"noisy image", "raw", "combined"});
  if (!color) color = &picture.layers.front();
  const Layer* const albedo = find(names.albedo, {"denoising albedo", "albedo"});
  const Layer* const normal = find(names.normal, {"denoising normal", "normal", "n"});
  if (!albedo != !normal) {
    throw InputError(fmt::format("has the layer '{}' but no {}, expected both or none",
                                 (albedo ? albedo : normal)->name, albedo ? "normals" : "albedo"));
  }
  Samples samples{1, picture.width, picture.height, values_of(*color, 3)};
  if (albedo) {
    samples.albedo = values_of(*albedo, 3);
    samples.normal = values_of(*normal, 3);
  }
  return samples;
}

}  // namespace gatelight::renderer
