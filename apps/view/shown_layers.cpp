#include "apps/view/shown_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "renderer/image/image_write.h"
#include "renderer/settings/aovs.h"
#include "renderer/settings/light_group_options.h"

namespace gatelight::apps {
namespace {

using renderer::AovLook;
using renderer::Layer;

constexpr int kBins = 64;

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// From dark blue over red to yellow, for 0 to 1.
std::array<std::uint8_t, 3> heat(float value) {
  constexpr std::array<std::array<float, 3>, 5> kRamp = {{{0.02f, 0.02f, 0.12f},
                                                          {0.30f, 0.07f, 0.48f},
                                                          {0.78f, 0.24f, 0.36f},
                                                          {0.98f, 0.58f, 0.18f},
                                                          {0.98f, 0.97f, 0.65f}}};
  const float place = std::clamp(value, 0.0f, 1.0f) * (kRamp.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  const float share = place - static_cast<float>(i);
  std::array<std::uint8_t, 3> bytes{};
  for (std::size_t c = 0; c < 3; ++c)
    bytes[c] = byte_of(kRamp[i][c] + share * (kRamp[i + 1][c] - kRamp[i][c]));
  return bytes;
}

/// The mean of the channels of each pixel.
std::vector<float> means(const Layer& layer) {
  const std::size_t channels = layer.channels.size();
  std::vector<float> result(layer.values.size() / channels);
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t c = 0; c < channels; ++c)
      result[i] += layer.values[i * channels + c] / static_cast<float>(channels);
  }
  return result;
}

/// So that nine tenths of the finite values above zero lie below 1.
float most_of(std::vector<float> values) {
  std::erase_if(values, [](float v) { return !(v > 0.0f) || !std::isfinite(v); });
  if (values.empty()) return 1.0f;
  const auto tenth = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 9 / 10);
  std::nth_element(values.begin(), tenth, values.end());
  return *tenth;
}

std::vector<std::uint8_t> by_heat(const Layer& layer) {
  const std::vector<float> values = means(layer);
  const float most = most_of(values);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * values.size());
  for (const float value : values) {
    const auto color = heat(std::isfinite(value) ? value / most : 1.0f);
    bytes.insert(bytes.end(), color.begin(), color.end());
  }
  return bytes;
}

std::vector<std::uint8_t> by_number(const Layer& layer) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * layer.values.size());
  for (const float value : layer.values) {
    const std::uint32_t bits =
        value < 0.0f ? 0u : ((static_cast<std::uint32_t>(value) + 1u) * 2654435761u) >> 8 | 0x404040u;
    for (const int shift : {0, 8, 16}) bytes.push_back(static_cast<std::uint8_t>(bits >> shift & 255u));
  }
  return bytes;
}

std::vector<std::uint8_t> by_direction(const Layer& layer) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(layer.values.size());
  for (const float value : layer.values) bytes.push_back(byte_of(0.5f + 0.5f * value));
  return bytes;
}

std::vector<std::uint8_t> as_light(const renderer::Picture& picture, Layer layer,
                                   const renderer::DisplayOptions& display) {
  layer.name.clear();
  renderer::Picture alone{.width = picture.width, .height = picture.height};
  alone.layers.push_back(std::move(layer));
  return renderer::display_bytes(alone, display);
}

}  // namespace

std::vector<std::uint8_t> layer_bytes(const renderer::Picture& picture, const std::string& name,
                                      const renderer::DisplayOptions& display) {
  if (name.empty()) return renderer::display_bytes(picture, display);
  const Layer* layer = picture.find(name);
  if (layer == nullptr || name.empty()) throw BadOption({"layer", name, "", "a layer of the picture"});
  const renderer::AovInfo* const aov = renderer::find_aov(name);
  const bool of_group = !aov && name.starts_with(renderer::kLightLayer);
  switch (aov ? aov->look : of_group ? AovLook::light : AovLook::heat) {
    case AovLook::light:
      return as_light(picture, *layer, display);
    case AovLook::color:
      return as_light(picture, *layer, {});
    case AovLook::direction:
      return by_direction(*layer);
    case AovLook::id:
      return by_number(*layer);
    case AovLook::heat:
      break;
  }
  return by_heat(*layer);
}

std::vector<int> histogram(const std::vector<std::uint8_t>& bytes) {
  std::vector<int> counts(3 * kBins);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    ++counts[(i % 3) * kBins + static_cast<std::size_t>(bytes[i]) * kBins / 256];
  return counts;
}

}  // namespace gatelight::apps
