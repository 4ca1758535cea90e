#pragma once

#include <array>
#include <string>

#include "renderer/image/image_write.h"
#include "renderer/image/picture.h"

namespace gatelight::apps {

inline constexpr int kMaxPictureWidth = 1280;

enum class PictureKind {
  light,
  /// Colours that stand for numbers: they are averaged as bytes, and need no more than half their resolution.
  map,
};

struct EmbeddedPicture {
  std::array<int, 2> size{};  ///< of the picture
  int width = 0;              ///< of the JPEG
  std::string uri;
};

/// The picture as its PNG would show it, as a JPEG in a data URI. Wider than max_width it is made smaller;
/// what is light by means of light, not of bytes.
EmbeddedPicture embed_picture(const renderer::Picture& picture, const renderer::ImageWriteOptions& display,
                              PictureKind kind = PictureKind::light, int max_width = kMaxPictureWidth);

}  // namespace gatelight::apps
