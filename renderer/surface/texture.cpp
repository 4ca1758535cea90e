#include "renderer/surface/texture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "renderer/image/srgb.h"
#include "scene/material_fields.h"

namespace gatelight::renderer {

namespace {

/// Maps any integer coordinate to [0, size - 1].
int wrap(int x, int size, scene::Wrap mode) {
  if (static_cast<unsigned>(x) < static_cast<unsigned>(size)) return x;
  switch (mode) {
    case scene::Wrap::clamp_to_edge:
      return x < 0 ? 0 : size - 1;
    case scene::Wrap::mirrored_repeat: {
      int m = x % (2 * size);
      if (m < 0) m += 2 * size;
      return m < size ? m : 2 * size - 1 - m;
    }
    case scene::Wrap::repeat:
      break;
  }
  const int m = x % size;
  return m < 0 ? m + size : m;
}

/// Converts a texture coordinate to texels. Coordinates that are not finite, or too large for an int, become
/// 0.
float texels_from(float coordinate, int size) {
  const float x = coordinate * static_cast<float>(size);
  return std::abs(x) < 1e9f ? x : 0.0f;
}

const TextureLevel& choose_level(const TexturePyramid& pyramid, const scene::TextureSlot& slot,
                                 float footprint, float u_level) {
  std::size_t index = 0;
  const int last = static_cast<int>(pyramid.levels.size()) - 1;
  if (footprint > 0.0f && last > 0) {
    // The area scale of the transform converts the footprint from uv to st. One texel of level l is 2^l /
    // size wide.
    const float scale = std::sqrt(
        std::abs(slot.transform(0, 0) * slot.transform(1, 1) - slot.transform(0, 1) * slot.transform(1, 0)));
    const float size = static_cast<float>(std::max(pyramid.levels[0].width, pyramid.levels[0].height));
    const float texels = footprint * scale * size;
    // log2 as the exponent plus a linear mantissa, within 0.09 of the true value.
    if (texels > 1.0f) {
      const std::uint32_t bits = std::bit_cast<std::uint32_t>(texels);
      const float lod = static_cast<float>(bits) * (1.0f / (1 << 23)) - 127.0f;
      index = static_cast<std::size_t>(std::clamp(static_cast<int>(lod + u_level), 0, last));
    }
  }
  return pyramid.levels[index];
}

Vec4 decode_16(std::uint64_t t) {
  const auto channel = [t](int shift) { return static_cast<float>(t >> shift & 65535); };
  return Vec4(channel(0), channel(16), channel(32), channel(48)) * (1.0f / 65535.0f);
}

/// Reads one level at the texture coordinate `st`: bilinear, or the nearest texel where the finest level of
/// the texture is to be read so.
template <class Texel, class Decode>
Vec4 filter(const scene::Texture& texture, const TextureLevel& level, const Vec2& st, const Texel* texels,
            const Decode& decode) {
  const float x = texels_from(st.x(), level.width);
  const float y = texels_from(st.y(), level.height);
  if (texture.nearest && level.offset == 0) {
    const int ix = wrap(static_cast<int>(std::floor(x)), level.width, texture.wrap_s);
    const int iy = wrap(static_cast<int>(std::floor(y)), level.height, texture.wrap_t);
    return decode(texels[texel_index(level.width, ix, iy)]);
  }
  const float fx = std::floor(x - 0.5f);
  const float fy = std::floor(y - 0.5f);
  const float wx = x - 0.5f - fx;
  const float wy = y - 0.5f - fy;
  const int x0 = wrap(static_cast<int>(fx), level.width, texture.wrap_s);
  const int x1 = wrap(static_cast<int>(fx) + 1, level.width, texture.wrap_s);
  const int y0 = wrap(static_cast<int>(fy), level.height, texture.wrap_t);
  const int y1 = wrap(static_cast<int>(fy) + 1, level.height, texture.wrap_t);
  const Vec4 top = decode(texels[texel_index(level.width, x0, y0)]) * (1.0f - wx) +
                   decode(texels[texel_index(level.width, x1, y0)]) * wx;
  const Vec4 bottom = decode(texels[texel_index(level.width, x0, y1)]) * (1.0f - wx) +
                      decode(texels[texel_index(level.width, x1, y1)]) * wx;
  return top * (1.0f - wy) + bottom * wy;
}

}  // namespace

Textures::Textures(const scene::Scene& scene) {
  pyramids_.resize(scene.images.size());
  // A pyramid for each image and encoding that some material reads.
  const auto need = [&](const scene::TextureSlot& slot, Encoding encoding) {
    const int image = slot ? scene.textures[static_cast<std::size_t>(slot.texture)].image : -1;
    if (image < 0) return;
    const scene::Image& source = scene.images[static_cast<std::size_t>(image)];
    auto& pyramid = pyramids_[static_cast<std::size_t>(image)][static_cast<std::size_t>(encoding)];
    if (!pyramid && source.width > 0 && source.height > 0) pyramid = std::make_unique<TexturePyramid>();
  };
  for (const scene::Material& m : scene.materials) {
    scene::for_each_slot(m, [&](const scene::TextureSlot& slot, bool is_color) {
      need(slot, is_color ? Encoding::srgb : Encoding::linear);
    });
  }

  tbb::parallel_for(std::size_t{0}, 2 * pyramids_.size(), [&](std::size_t i) {
    if (!pyramids_[i / 2][i % 2]) return;
    *pyramids_[i / 2][i % 2] = build_pyramid(scene.images[i / 2], static_cast<Encoding>(i % 2));
  });

  for (const scene::Texture& texture : scene.textures) {
    Lookup& lookup = lookups_.emplace_back();
    lookup.texture = texture;
    if (texture.image < 0) continue;
    const auto& pyramids = pyramids_[static_cast<std::size_t>(texture.image)];
    for (std::size_t i = 0; i < pyramids.size(); ++i) {
      if (!pyramids[i]) continue;
      (pyramids[i]->texels_16.empty() ? lookup.pyramid : lookup.pyramid_16)[i] = pyramids[i].get();
    }
  }
}

Vec4 Textures::lookup(const scene::TextureSlot& slot, Encoding encoding, const Vec2& uv, float footprint,
                      float u_level) const {
  const Lookup& lookup = lookups_[static_cast<std::size_t>(slot.texture)];
  const Vec2 st = slot.transform.leftCols<2>() * uv + slot.transform.col(2);
  const TexturePyramid* pyramid = lookup.pyramid[static_cast<std::size_t>(encoding)];
  if (pyramid) [[likely]] {
    const TextureLevel& level = choose_level(*pyramid, slot, footprint, u_level);
    const auto decode = [&](std::uint32_t t) -> Vec4 {
      if (encoding == Encoding::srgb) {
        return {kSrgbToLinear[t & 255], kSrgbToLinear[t >> 8 & 255], kSrgbToLinear[t >> 16 & 255],
                static_cast<float>(t >> 24) * (1.0f / 255.0f)};
      }
      return Vec4(static_cast<float>(t & 255), static_cast<float>(t >> 8 & 255),
                  static_cast<float>(t >> 16 & 255), static_cast<float>(t >> 24)) *
             (1.0f / 255.0f);
    };
    return filter(lookup.texture, level, st, pyramid->texels.data() + level.offset, decode);
  }
  pyramid = lookup.pyramid_16[static_cast<std::size_t>(encoding)];
  if (!pyramid) return Vec4::Ones();
  const TextureLevel& level = choose_level(*pyramid, slot, footprint, u_level);
  return filter(lookup.texture, level, st, pyramid->texels_16.data() + level.offset, decode_16);
}

Vec4 Textures::mean(const scene::TextureSlot& slot, Encoding encoding) const {
  const Lookup& lookup = lookups_[static_cast<std::size_t>(slot.texture)];
  const auto i = static_cast<std::size_t>(encoding);
  const TexturePyramid* pyramid = lookup.pyramid[i] ? lookup.pyramid[i] : lookup.pyramid_16[i];
  return pyramid ? pyramid->mean : Vec4::Ones();
}

std::size_t Textures::bytes() const {
  std::size_t total = 0;
  for (const auto& encodings : pyramids_) {
    for (const auto& pyramid : encodings) {
      if (!pyramid) continue;
      total += pyramid->texels.size() * sizeof(std::uint32_t);
      total += pyramid->texels_16.size() * sizeof(std::uint64_t);
    }
  }
  return total;
}

}  // namespace gatelight::renderer
