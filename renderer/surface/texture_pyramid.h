#pragma once
// A mip pyramid of one picture.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

/// How the values of a colour channel are decoded. Alpha is always linear.
enum class Encoding : std::uint8_t { linear, srgb };

struct TextureLevel {
  int width = 0;
  int height = 0;
  std::size_t offset = 0;  ///< of its first texel
};

/// Texels are stored in blocks of 4x4, one cache line of 8 bits a channel, so that a bilinear lookup
/// reads 1.6 lines on average.
inline std::size_t texture_blocks(int texels) {
  return static_cast<std::size_t>((texels + 3) / 4);
}
inline std::size_t texel_index(int width, int x, int y) {
  const std::size_t block =
      static_cast<std::size_t>(y >> 2) * texture_blocks(width) + static_cast<std::size_t>(x >> 2);
  return block * 16 + static_cast<std::size_t>((y & 3) * 4 + (x & 3));
}

/// Either `texels` or `texels_16` is filled, as the picture has 8 or 16 bits.
struct TexturePyramid {
  std::vector<TextureLevel> levels;
  std::vector<std::uint32_t> texels;     ///< RGBA8, R in the low byte, colours in the pyramid's encoding
  std::vector<std::uint64_t> texels_16;  ///< RGBA16, R in the low bits, linear
  Vec4 mean = Vec4::Zero();
};

/// The picture has at least one pixel.
TexturePyramid build_pyramid(const scene::Image& image, Encoding encoding);

}  // namespace gatelight::renderer
