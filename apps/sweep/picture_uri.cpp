#include "apps/sweep/picture_uri.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/image/jpeg_write.h"
#include "renderer/image/image_library.h"
#include "renderer/image/srgb.h"

namespace gatelight::apps {
namespace {

struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;  ///< RGB, sRGB
};

float decode(std::uint8_t byte, PictureKind kind) {
  return kind == PictureKind::map ? static_cast<float>(byte) / 255.0f : renderer::kSrgbToLinear[byte];
}

std::uint8_t encode(float value, PictureKind kind) {
  if (kind == PictureKind::light) return renderer::display_byte(value, 1.0f, renderer::Tonemap::none);
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

Pixels shrink(const Pixels& pixels, PictureKind kind, int width) {
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(pixels.height) * width / pixels.width)));
  std::vector<float> values(pixels.bytes.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = decode(pixels.bytes[i], kind);
  values = renderer::image_library().resize(values, pixels.width, pixels.height, width, height);
  Pixels smaller{.width = width, .height = height};
  smaller.bytes.reserve(values.size());
  for (const float x : values) smaller.bytes.push_back(encode(x, kind));
  return smaller;
}

/// Base64 (RFC 4648, section 4).
std::string encode_base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

}  // namespace

EmbeddedPicture embed_picture(const renderer::Picture& picture, const renderer::ImageWriteOptions& display,
                              PictureKind kind, int max_width) {
  Pixels pixels{picture.width, picture.height, renderer::display_bytes(picture, display.display)};
  if (pixels.width > max_width) pixels = shrink(pixels, kind, max_width);
  const bool map = kind == PictureKind::map;
  // Noise is coloured, so subsampled colour would change what is compared.
  const std::vector<std::uint8_t> jpeg =
      encode_jpeg(pixels.bytes, pixels.width, pixels.height, map ? 75 : 88, map);
  return {.size = {picture.width, picture.height},
          .width = pixels.width,
          .uri = "data:image/jpeg;base64," + encode_base64(jpeg)};
}

}  // namespace gatelight::apps
