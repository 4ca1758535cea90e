#pragma once

#include <string>

#include "renderer/image_write.h"
#include "renderer/picture.h"

namespace gatelight::apps {

inline constexpr int kMaxPictureWidth = 1280;

/// The picture as its PNG would show it, as a JPEG in a data URI. Wider than kMaxPictureWidth it is made
/// smaller, by means of light, not of bytes.
std::string picture_uri(const renderer::Picture& picture, const renderer::ImageWriteOptions& display);

}  // namespace gatelight::apps
