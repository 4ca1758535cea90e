#pragma once

#include <array>
#include <string>

#include "renderer/image/image_write.h"
#include "renderer/image/picture.h"

namespace gatelight::apps {

inline constexpr int kMaxPictureWidth = 1280;

enum class PictureKind {
  light,
  /// A colour map of numbers: bytes are averaged, and colour has half the resolution.
  map,
};

struct EmbeddedPicture {
  std::array<int, 2> size{};  ///< of the picture
  int width = 0;              ///< of the JPEG
  std::string uri;
};

/// The picture as its PNG would show it, as a JPEG in a data URI. It is scaled down to max_width; `light`
/// pictures are averaged in linear light.
EmbeddedPicture embed_picture(const renderer::Picture& picture, const renderer::ImageWriteOptions& display,
                              PictureKind kind = PictureKind::light, int max_width = kMaxPictureWidth);

}  // namespace gatelight::apps
