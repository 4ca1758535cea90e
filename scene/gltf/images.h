#pragma once
// Decodes PNG (libpng), JPEG (libjpeg) and WebP (libwebp).

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

struct ImageOptions {
  bool missing_is_error = true;  ///< else an unreadable image becomes one white pixel and a warning
  bool normal_map = false;       ///< keeps 16 bits; all other pictures get 8
};

/// Reads and decodes image `index` of the file. Thread-safe. Throws InputError for an unreadable image.
Image load_image(const Document& document, int index, const ImageOptions& options, Warnings& warnings);

}  // namespace gatelight::scene::gltf
