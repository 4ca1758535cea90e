#include "apps/sweep/picture_uri.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/image/jpeg_write.h"
#include "renderer/film/scale_down.h"
#include "renderer/image/image_write.h"
#include "renderer/image/srgb.h"

namespace gatelight::apps {
namespace {

/// Means of squares of `side` pixels in linear light; what is left at the right and at the bottom is cut off.
std::vector<std::uint8_t> shrink(const std::vector<std::uint8_t>& bytes, int width, int height, int side,
                                 int rows) {
  std::vector<float> light;
  light.reserve(bytes.size());
  for (const std::uint8_t byte : bytes) light.push_back(renderer::kSrgbToLinear[byte]);
  const renderer::ScaleDown squares(side, renderer::PixelFilter::box, 1.0f);
  std::vector<std::uint8_t> smaller;
  for (const float mean : squares.scale(light, 3, width, height, 0, 0, rows))
    smaller.push_back(renderer::display_byte(mean, 1.0f, renderer::Tonemap::none));
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

std::string picture_uri(const renderer::Picture& picture, const renderer::DisplayOptions& display) {
  constexpr int kMaxWidth = 1280, kQuality = 88;
  const int side = (picture.width + kMaxWidth - 1) / kMaxWidth;
  const int columns = picture.width / side, rows = std::max(1, picture.height / side);
  std::vector<std::uint8_t> bytes = renderer::display_bytes(picture, display);
  if (side > 1) bytes = shrink(bytes, picture.width, picture.height, side, rows);
  return "data:image/jpeg;base64," + encode_base64(encode_jpeg(bytes, columns, rows, kQuality));
}

}  // namespace gatelight::apps
