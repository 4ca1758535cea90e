#pragma once
// Converts glTF materials, textures and samplers.

#include <vector>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// Material `index` of the file, or glTF's default material for -1. Texture indices are the file's. Factors
/// outside their range are clamped, with a warning.
Material convert_material(const Document& document, int index, Warnings& warnings);

/// Texture `index` of the file. The image index is the file's. The texture has an image.
Texture convert_texture(const Document& document, int index);

}  // namespace gatelight::scene::gltf
