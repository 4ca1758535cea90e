#include "renderer/surface/texture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "renderer/image/srgb.h"
#include "scene/texture_slots.h"

namespace gatelight::renderer {

namespace {

/// Texels are stored in blocks of 4x4, one cache line, so that a bilinear lookup reads 1.6 lines on average.
constexpr int kBlock = 4;

int blocks(int texels) {
  return (texels + kBlock - 1) / kBlock;
}

std::size_t stored_texels(int width, int height) {
  return static_cast<std::size_t>(blocks(width)) * static_cast<std::size_t>(blocks(height)) * kBlock * kBlock;
}

std::size_t block_index(int width, int x, int y) {
  const std::size_t block = static_cast<std::size_t>(y >> 2) * static_cast<std::size_t>(blocks(width)) +
                            static_cast<std::size_t>(x >> 2);
  return block * 16 + static_cast<std::size_t>((y & 3) * 4 + (x & 3));
}

/// Linear RGBA of the level that is being built, in row-major order.
using FloatLevel = std::vector<Vec4>;

using Rgba8 = std::array<std::uint8_t, 4>;

/// A pixel of the file, with grey and alpha expanded.
Rgba8 texel_of(const scene::Image& image, std::size_t texel) {
  const std::uint8_t* p = image.pixels.data() + texel * static_cast<std::size_t>(image.channels);
  const bool grey = image.channels < 3;
  const std::uint8_t alpha = image.channels == 2 ? p[1] : image.channels == 4 ? p[3] : 255;
  return {p[0], grey ? p[0] : p[1], grey ? p[0] : p[2], alpha};
}

Vec4 to_float(const Rgba8& p, Encoding encoding) {
  const auto color = [&](std::uint8_t byte) {
    return encoding == Encoding::srgb ? kSrgbToLinear[byte] : static_cast<float>(byte) * (1.0f / 255.0f);
  };
  return {color(p[0]), color(p[1]), color(p[2]), p[3] / 255.0f};
}

FloatLevel to_float(const scene::Image& image, Encoding encoding) {
  FloatLevel level(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (std::size_t i = 0; i < level.size(); ++i) level[i] = to_float(texel_of(image, i), encoding);
  return level;
}

/// Area-weighted reduction along one axis. It is exact for odd sizes, where two result texels share a source
/// texel.
FloatLevel halve(const FloatLevel& source, int width, int height, bool along_x) {
  const int length = along_x ? width : height;
  const int half = std::max(1, length / 2);
  const int other = along_x ? height : width;
  const float ratio = static_cast<float>(length) / static_cast<float>(half);
  FloatLevel result(static_cast<std::size_t>(half) * static_cast<std::size_t>(other));
  const auto index = [&](int along, int across, int row) {
    const int x = along_x ? along : across;
    const int y = along_x ? across : along;
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(row) + static_cast<std::size_t>(x);
  };
  for (int i = 0; i < half; ++i) {
    const float begin = static_cast<float>(i) * ratio;
    const float end = begin + ratio;
    const int first = static_cast<int>(begin);
    const int last = std::min(length - 1, static_cast<int>(std::ceil(end)) - 1);
    for (int j = 0; j < other; ++j) {
      Vec4 sum = Vec4::Zero();
      for (int k = first; k <= last; ++k) {
        const float weight =
            std::min(end, static_cast<float>(k + 1)) - std::max(begin, static_cast<float>(k));
        sum += weight * source[index(k, j, width)];
      }
      result[index(i, j, along_x ? half : width)] = sum / ratio;
    }
  }
  return result;
}

/// Both axes at once, for even sizes: the same sums as halve() for x and then for y. texel(i) is the source's
/// texel number i.
template <class Texel>
FloatLevel halve_even(int width, int height, const Texel& texel) {
  const auto row = static_cast<std::size_t>(width);
  FloatLevel result(row / 2 * static_cast<std::size_t>(height / 2));
  tbb::parallel_for(tbb::blocked_range<int>(0, height / 2, 32), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin(); y < range.end(); ++y) {
      const std::size_t top = 2 * static_cast<std::size_t>(y) * row;
      Vec4* const to = result.data() + static_cast<std::size_t>(y) * (row / 2);
      for (std::size_t x = 0; x < row / 2; ++x) {
        const std::size_t i = top + 2 * x;
        const Vec4 upper = (texel(i) + texel(i + 1)) * 0.5f;
        const Vec4 lower = (texel(i + row) + texel(i + row + 1)) * 0.5f;
        to[x] = (upper + lower) * 0.5f;
      }
    }
  });
  return result;
}

/// linear_to_srgb() in 8 bits without its power: the bytes begin at known values.
class SrgbBytes {
 public:
  SrgbBytes() {
    for (std::size_t b = 1; b < 256; ++b) {
      // The smallest float that is rounded to b or more, by bisection of the bits.
      std::uint32_t low = 0, high = std::bit_cast<std::uint32_t>(1.0f);
      while (low < high) {
        const std::uint32_t middle = low + (high - low) / 2;
        if (linear_to_srgb(std::bit_cast<float>(middle)) * 255.0f + 0.5f >= static_cast<float>(b)) {
          high = middle;
        } else {
          low = middle + 1;
        }
      }
      begin_[b] = std::bit_cast<float>(low);
    }
    begin_[256] = 2.0f;
    std::size_t byte = 0;
    for (std::size_t i = 0; i <= kGuides; ++i) {
      while (begin_[byte + 1] <= static_cast<float>(i) / kGuides) ++byte;
      guide_[i] = static_cast<std::uint8_t>(byte);
    }
  }
  /// x is in [0, 1].
  std::uint8_t operator()(float x) const {
    std::size_t byte = guide_[static_cast<std::size_t>(x * kGuides)];
    while (begin_[byte + 1] <= x) ++byte;
    return static_cast<std::uint8_t>(byte);
  }

 private:
  static constexpr std::size_t kGuides = 4096;
  std::array<float, 257> begin_{};
  std::array<std::uint8_t, kGuides + 1> guide_{};
};

std::uint32_t pack(const Rgba8& c) {
  return c[0] | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16 | std::uint32_t{c[3]} << 24;
}

std::uint32_t pack(const Vec4& c, Encoding encoding) {
  static const SrgbBytes srgb_byte;
  const Vec4 inside = c.cwiseMax(0.0f).cwiseMin(1.0f);
  const auto byte = [](float x) {
    return static_cast<std::uint8_t>(x * 255.0f +
                                     0.5f);  // NOLINT(bugprone-incorrect-roundings): never negative
  };
  const auto color = [&](float x) { return encoding == Encoding::srgb ? srgb_byte(x) : byte(x); };
  return pack({color(inside.x()), color(inside.y()), color(inside.z()), byte(inside.w())});
}

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

}  // namespace

Textures::Textures(const scene::Scene& scene) {
  pyramids_.resize(scene.images.size());
  // A pyramid for each image and encoding that some material reads.
  const auto need = [&](const scene::TextureSlot& slot, Encoding encoding) {
    const int image = slot ? scene.textures[static_cast<std::size_t>(slot.texture)].image : -1;
    if (image < 0) return;
    const scene::Image& source = scene.images[static_cast<std::size_t>(image)];
    auto& pyramid = pyramids_[static_cast<std::size_t>(image)][static_cast<std::size_t>(encoding)];
    if (!pyramid && source.width > 0 && source.height > 0) pyramid = std::make_unique<Pyramid>();
  };
  for (const scene::Material& m : scene.materials) {
    scene::for_each_slot(m, [&](const scene::TextureSlot& slot, bool is_color) {
      need(slot, is_color ? Encoding::srgb : Encoding::linear);
    });
  }

  tbb::parallel_for(std::size_t{0}, 2 * pyramids_.size(), [&](std::size_t i) {
    if (!pyramids_[i / 2][i % 2]) return;
    Pyramid& pyramid = *pyramids_[i / 2][i % 2];
    const scene::Image& image = scene.images[i / 2];
    const auto encoding = static_cast<Encoding>(i % 2);
    FloatLevel level;  // of `width` and `height`, empty for the finest
    int width = image.width;
    int height = image.height;
    std::size_t total = 0;
    for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
      total += stored_texels(w, h);
      if (w == 1 && h == 1) break;
    }
    pyramid.texels.resize(total);
    std::size_t offset = 0;
    for (;;) {
      pyramid.levels.push_back({width, height, offset});
      tbb::parallel_for(tbb::blocked_range<int>(0, height, 32), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
          for (int x = 0; x < width; ++x) {
            const std::size_t texel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            pyramid.texels[offset + block_index(width, x, y)] =
                offset == 0 ? pack(texel_of(image, texel)) : pack(level[texel], encoding);
          }
        }
      });
      const bool finest = offset == 0;
      offset += stored_texels(width, height);
      if (width == 1 && height == 1) break;
      if (width % 2 == 0 && height % 2 == 0) {
        level = finest ? halve_even(width, height,
                                    [&](std::size_t t) { return to_float(texel_of(image, t), encoding); })
                       : halve_even(width, height, [&](std::size_t t) -> const Vec4& { return level[t]; });
        width /= 2;
        height /= 2;
        continue;
      }
      if (finest) level = to_float(image, encoding);
      if (width > 1) {
        level = halve(level, width, height, true);
        width /= 2;
      }
      if (height > 1) {
        level = halve(level, width, height, false);
        height /= 2;
      }
    }
    if (level.empty()) level = to_float(image, encoding);  // a picture of one texel
    pyramid.mean = level[0];
  });

  for (const scene::Texture& texture : scene.textures) {
    Lookup& lookup = lookups_.emplace_back();
    lookup.texture = texture;
    if (texture.image < 0) continue;
    const auto& pyramids = pyramids_[static_cast<std::size_t>(texture.image)];
    lookup.pyramid[0] = pyramids[0].get();
    lookup.pyramid[1] = pyramids[1].get();
  }
}

Vec4 Textures::lookup(const scene::TextureSlot& slot, Encoding encoding, const Vec2& uv, float footprint,
                      float u_level) const {
  const Lookup& lookup = lookups_[static_cast<std::size_t>(slot.texture)];
  const Pyramid* pyramid = lookup.pyramid[static_cast<std::size_t>(encoding)];
  if (!pyramid) return Vec4::Ones();
  const Vec2 st = slot.transform.leftCols<2>() * uv + slot.transform.col(2);

  std::size_t index = 0;
  const int last = static_cast<int>(pyramid->levels.size()) - 1;
  if (footprint > 0.0f && last > 0) {
    // The area scale of the transform converts the footprint from uv to st. One texel of level l is 2^l /
    // size wide.
    const float scale = std::sqrt(
        std::abs(slot.transform(0, 0) * slot.transform(1, 1) - slot.transform(0, 1) * slot.transform(1, 0)));
    const float size = static_cast<float>(std::max(pyramid->levels[0].width, pyramid->levels[0].height));
    const float texels = footprint * scale * size;
    // log2 as the exponent plus a linear mantissa, within 0.09 of the true value.
    if (texels > 1.0f) {
      const std::uint32_t bits = std::bit_cast<std::uint32_t>(texels);
      const float lod = static_cast<float>(bits) * (1.0f / (1 << 23)) - 127.0f;
      index = static_cast<std::size_t>(std::clamp(static_cast<int>(lod + u_level), 0, last));
    }
  }
  const Level& level = pyramid->levels[index];
  const std::uint32_t* texels = pyramid->texels.data() + level.offset;

  const auto decode = [&](std::uint32_t t) -> Vec4 {
    if (encoding == Encoding::srgb) {
      return {kSrgbToLinear[t & 255], kSrgbToLinear[t >> 8 & 255], kSrgbToLinear[t >> 16 & 255],
              static_cast<float>(t >> 24) * (1.0f / 255.0f)};
    }
    return Vec4(static_cast<float>(t & 255), static_cast<float>(t >> 8 & 255),
                static_cast<float>(t >> 16 & 255), static_cast<float>(t >> 24)) *
           (1.0f / 255.0f);
  };

  const float x = texels_from(st.x(), level.width);
  const float y = texels_from(st.y(), level.height);
  if (lookup.texture.nearest && index == 0) {
    const int ix = wrap(static_cast<int>(std::floor(x)), level.width, lookup.texture.wrap_s);
    const int iy = wrap(static_cast<int>(std::floor(y)), level.height, lookup.texture.wrap_t);
    return decode(texels[block_index(level.width, ix, iy)]);
  }
  const float fx = std::floor(x - 0.5f);
  const float fy = std::floor(y - 0.5f);
  const float wx = x - 0.5f - fx;
  const float wy = y - 0.5f - fy;
  const int x0 = wrap(static_cast<int>(fx), level.width, lookup.texture.wrap_s);
  const int x1 = wrap(static_cast<int>(fx) + 1, level.width, lookup.texture.wrap_s);
  const int y0 = wrap(static_cast<int>(fy), level.height, lookup.texture.wrap_t);
  const int y1 = wrap(static_cast<int>(fy) + 1, level.height, lookup.texture.wrap_t);
  const Vec4 top = decode(texels[block_index(level.width, x0, y0)]) * (1.0f - wx) +
                   decode(texels[block_index(level.width, x1, y0)]) * wx;
  const Vec4 bottom = decode(texels[block_index(level.width, x0, y1)]) * (1.0f - wx) +
                      decode(texels[block_index(level.width, x1, y1)]) * wx;
  return top * (1.0f - wy) + bottom * wy;
}

Vec4 Textures::mean(const scene::TextureSlot& slot, Encoding encoding) const {
  const Pyramid* pyramid =
      lookups_[static_cast<std::size_t>(slot.texture)].pyramid[static_cast<std::size_t>(encoding)];
  return pyramid ? pyramid->mean : Vec4::Ones();
}

std::size_t Textures::bytes() const {
  std::size_t total = 0;
  for (const auto& encodings : pyramids_) {
    for (const auto& pyramid : encodings) {
      if (pyramid) total += pyramid->texels.size() * sizeof(std::uint32_t);
    }
  }
  return total;
}

}  // namespace gatelight::renderer
