#pragma once
// Decodes PNG (libpng), JPEG (libjpeg) and WebP (libwebp) to 8-bit pixels.

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// Reads and decodes image `index` of the file. Thread-safe. An unreadable image throws InputError; if
/// `missing_is_error` is false, it becomes one white pixel and a warning.
Image load_image(const Document& document, int index, bool missing_is_error, Warnings& warnings);

}  // namespace gatelight::scene::gltf
