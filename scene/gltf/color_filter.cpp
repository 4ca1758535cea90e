#include "scene/gltf/color_filter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace gatelight::scene::gltf {
namespace {

/// After appendix B of the extension: Y and A are unsigned, Co and Cg signed, all of K bits. The highest bit
/// of A is set, which tells K, and its others are the alpha of K - 1 bits.
template <class Channel>
void decode(std::uint8_t* bytes) {
  constexpr int kGreatest = std::numeric_limits<Channel>::max();
  Channel color[4];
  std::memcpy(color, bytes, sizeof color);
  const auto signed_value = [](Channel x) { return int{static_cast<std::make_signed_t<Channel>>(x)}; };
  const int y = color[0], co = signed_value(color[1]), cg = signed_value(color[2]);
  const int greatest = std::max((1 << std::bit_width(color[3])) - 1, 1);
  const int low = color[3] & greatest >> 1;
  const int alpha = low << 1 | (low & 1);
  const float scale = static_cast<float>(kGreatest) / static_cast<float>(greatest);
  // Data that no encoder writes may lie outside.
  const auto scaled = [&](int x) {
    return static_cast<Channel>(std::clamp(std::lround(static_cast<float>(x) * scale), 0L, long{kGreatest}));
  };
  const Channel rgba[4] = {scaled(y + co - cg), scaled(y + cg), scaled(y - co - cg), scaled(alpha)};
  std::memcpy(bytes, rgba, sizeof rgba);
}

}  // namespace

void decode_color_filter(std::span<std::uint8_t> bytes, std::size_t stride) {
  for (std::size_t i = 0; i + stride <= bytes.size(); i += stride) {
    if (stride == 4) {
      decode<std::uint8_t>(&bytes[i]);
    } else {
      decode<std::uint16_t>(&bytes[i]);
    }
  }
}

}  // namespace gatelight::scene::gltf
