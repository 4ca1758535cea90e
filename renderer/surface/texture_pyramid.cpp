#include "renderer/surface/texture_pyramid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "renderer/image/srgb.h"

namespace gatelight::renderer {

namespace {

std::size_t stored_texels(int width, int height) {
  return texture_blocks(width) * texture_blocks(height) * 16;
}

/// Linear RGBA of the level that is being built, in row-major order.
using FloatLevel = std::vector<Vec4>;

/// A pixel of the file, with grey and alpha expanded.
template <class Value>
std::array<Value, 4> expand(const std::vector<Value>& pixels, int channels, std::size_t texel) {
  const Value* const p = pixels.data() + texel * static_cast<std::size_t>(channels);
  const bool grey = channels < 3;
  const Value alpha = channels == 2 ? p[1] : channels == 4 ? p[3] : std::numeric_limits<Value>::max();
  return {p[0], grey ? p[0] : p[1], grey ? p[0] : p[2], alpha};
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

/// Reads pixels of 8 bits, and stores texels in the encoding of the picture.
class Format8 {
 public:
  Format8(const scene::Image& image, Encoding encoding) : image_(image), encoding_(encoding) {}

  std::uint32_t stored(std::size_t texel) const {
    return pack(expand(image_.pixels, image_.channels, texel));
  }
  Vec4 linear(std::size_t texel) const {
    const Rgba p = expand(image_.pixels, image_.channels, texel);
    const auto color = [&](std::uint8_t byte) {
      return encoding_ == Encoding::srgb ? kSrgbToLinear[byte] : static_cast<float>(byte) * (1.0f / 255.0f);
    };
    return {color(p[0]), color(p[1]), color(p[2]), p[3] / 255.0f};
  }
  std::uint32_t pack(const Vec4& c) const {
    static const SrgbBytes srgb_byte;
    const Vec4 inside = c.cwiseMax(0.0f).cwiseMin(1.0f);
    const auto byte = [](float x) {
      return static_cast<std::uint8_t>(x * 255.0f +
                                       0.5f);  // NOLINT(bugprone-incorrect-roundings): never negative
    };
    const auto color = [&](float x) { return encoding_ == Encoding::srgb ? srgb_byte(x) : byte(x); };
    return pack(Rgba{color(inside.x()), color(inside.y()), color(inside.z()), byte(inside.w())});
  }

 private:
  using Rgba = std::array<std::uint8_t, 4>;

  static std::uint32_t pack(const Rgba& c) {
    return c[0] | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16 | std::uint32_t{c[3]} << 24;
  }

  const scene::Image& image_;
  Encoding encoding_;
};

/// Reads pixels of 16 bits, and stores linear texels.
class Format16 {
 public:
  Format16(const scene::Image& image, Encoding encoding) : image_(image), encoding_(encoding) {}

  std::uint64_t stored(std::size_t texel) const { return pack(linear(texel)); }
  Vec4 linear(std::size_t texel) const {
    const std::array<std::uint16_t, 4> p = expand(image_.pixels_16, image_.channels, texel);
    const auto color = [&](std::uint16_t value) {
      const float x = value / 65535.0f;
      return encoding_ == Encoding::srgb ? srgb_to_linear(x) : x;
    };
    return {color(p[0]), color(p[1]), color(p[2]), p[3] / 65535.0f};
  }
  std::uint64_t pack(const Vec4& c) const {
    std::uint64_t packed = 0;
    for (int i = 0; i < 4; ++i) {
      const float x = std::clamp(c[i], 0.0f, 1.0f) * 65535.0f + 0.5f;
      packed |= static_cast<std::uint64_t>(x) << (16 * i);
    }
    return packed;
  }

 private:
  const scene::Image& image_;
  Encoding encoding_;
};

template <class Format>
FloatLevel to_float(const Format& format, int width, int height) {
  FloatLevel level(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < level.size(); ++i) level[i] = format.linear(i);
  return level;
}

/// Fills `texels`, the levels and the mean of `pyramid`.
template <class Format, class Texel>
void build(const Format& format, int width, int height, TexturePyramid& pyramid, std::vector<Texel>& texels) {
  FloatLevel level;  // of `width` and `height`, empty for the finest
  std::size_t total = 0;
  for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    total += stored_texels(w, h);
    if (w == 1 && h == 1) break;
  }
  texels.resize(total);
  std::size_t offset = 0;
  for (;;) {
    pyramid.levels.push_back({width, height, offset});
    tbb::parallel_for(tbb::blocked_range<int>(0, height, 32), [&](const tbb::blocked_range<int>& range) {
      for (int y = range.begin(); y < range.end(); ++y) {
        for (int x = 0; x < width; ++x) {
          const std::size_t texel =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
          texels[offset + texel_index(width, x, y)] =
              offset == 0 ? format.stored(texel) : format.pack(level[texel]);
        }
      }
    });
    const bool finest = offset == 0;
    offset += stored_texels(width, height);
    if (width == 1 && height == 1) break;
    if (width % 2 == 0 && height % 2 == 0) {
      level = finest ? halve_even(width, height, [&](std::size_t t) { return format.linear(t); })
                     : halve_even(width, height, [&](std::size_t t) -> const Vec4& { return level[t]; });
      width /= 2;
      height /= 2;
      continue;
    }
    if (finest) level = to_float(format, width, height);
    if (width > 1) {
      level = halve(level, width, height, true);
      width /= 2;
    }
    if (height > 1) {
      level = halve(level, width, height, false);
      height /= 2;
    }
  }
  if (level.empty()) level = to_float(format, width, height);  // a picture of one texel
  pyramid.mean = level[0];
}

}  // namespace

TexturePyramid build_pyramid(const scene::Image& image, Encoding encoding) {
  TexturePyramid pyramid;
  if (image.pixels_16.empty()) {
    build(Format8(image, encoding), image.width, image.height, pyramid, pyramid.texels);
  } else {
    build(Format16(image, encoding), image.width, image.height, pyramid, pyramid.texels_16);
  }
  return pyramid;
}

}  // namespace gatelight::renderer
