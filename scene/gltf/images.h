#pragma once
// Decodes PNG (libpng), JPEG (libjpeg) and WebP (libwebp).

#include <cstdint>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// The only use of an image, or one of several.
enum class ImageUse : std::uint8_t {
  any,
  normal_map,  ///< keeps 16 bits; all other pictures get 8
  emission,
};

struct ImageOptions {
  /// Otherwise an unreadable image becomes one pixel, with a warning: white, flat as a normal map, or black
  /// as emission.
  bool missing_is_error = true;
  ImageUse use = ImageUse::any;
};

/// Reads and decodes image `index` of the file. Thread-safe. Throws InputError for an unreadable image.
Image load_image(const Document& document, int index, const ImageOptions& options, Warnings& warnings);

}  // namespace gatelight::scene::gltf
