#include "renderer/image/color_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

namespace gatelight::renderer {
namespace {

std::size_t index_of(const Layer& layer, const char* name) {
  const auto found = std::find(layer.channels.begin(), layer.channels.end(), name);
  return static_cast<std::size_t>(found - layer.channels.begin());
}

std::optional<std::array<std::size_t, 3>> channels_named(const Layer& layer,
                                                         const std::array<const char*, 3>& names) {
  std::array<std::size_t, 3> index{};
  std::transform(names.begin(), names.end(), index.begin(),
                 [&](const char* name) { return index_of(layer, name); });
  if (*std::max_element(index.begin(), index.end()) == layer.channels.size()) return std::nullopt;
  return index;
}

}  // namespace

std::optional<std::array<std::size_t, 3>> color_channels(const Layer& layer) {
  if (const auto index = channels_named(layer, {"R", "G", "B"})) return index;
  // An incomplete colour does not count as one, and a layer with X is a position.
  const auto has = [&](const char* name) { return index_of(layer, name) < layer.channels.size(); };
  const std::size_t grey = index_of(layer, "Y");
  if (!has("Y") || has("X") || has("R") || has("G") || has("B")) return std::nullopt;
  return std::array{grey, grey, grey};
}

std::optional<std::array<std::size_t, 3>> vector_channels(const Layer& layer) {
  const auto index = channels_named(layer, {"X", "Y", "Z"});
  return index ? index : channels_named(layer, {"R", "G", "B"});
}

std::string describe_channels(const Layer& layer) {
  constexpr std::size_t kMax = 8;
  const std::span names(layer.channels.data(), std::min(layer.channels.size(), kMax));
  return fmt::format("channels {}{}, expected R, G and B, or Y", fmt::join(names, ", "),
                     layer.channels.size() > kMax ? ", ..." : "");
}

}  // namespace gatelight::renderer
