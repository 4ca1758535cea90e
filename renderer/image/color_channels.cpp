#include "renderer/image/color_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

namespace gatelight::renderer {

std::optional<std::array<std::size_t, 3>> color_channels(const Layer& layer) {
  const auto begin = layer.channels.begin();
  const auto end = layer.channels.end();
  const auto find = [&](const char* name) { return std::find(begin, end, name); };
  const std::array rgb{find("R"), find("G"), find("B")};
  if (std::find(rgb.begin(), rgb.end(), end) == rgb.end()) {
    std::array<std::size_t, 3> index{};
    std::transform(rgb.begin(), rgb.end(), index.begin(),
                   [&](auto it) { return static_cast<std::size_t>(it - begin); });
    return index;
  }
  // An incomplete colour does not count as one, and a layer with X is a position.
  const bool others =
      find("X") != end || std::any_of(rgb.begin(), rgb.end(), [&](auto it) { return it != end; });
  const auto grey = find("Y");
  if (grey == end || others) return std::nullopt;
  const std::size_t at = static_cast<std::size_t>(grey - begin);
  return std::array{at, at, at};
}

std::string describe_channels(const Layer& layer) {
  constexpr std::size_t kMost = 8;
  const std::span names(layer.channels.data(), std::min(layer.channels.size(), kMost));
  return fmt::format("channels {}{}, expected R, G and B, or Y", fmt::join(names, ", "),
                     layer.channels.size() > kMost ? ", ..." : "");
}

}  // namespace gatelight::renderer
