#pragma once
// PNG and JPEG to 8-bit pixels, through OpenImageIO.

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// Reads and decodes image number `index` of the file. May be called by several threads. An image that cannot
/// be had is an error, or, if `missing_is_error` is off, one white pixel and a warning.
Image load_image(const Document& document, int index, bool missing_is_error, Warnings& warnings);

}  // namespace gatelight::scene::gltf
