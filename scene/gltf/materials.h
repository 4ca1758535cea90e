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

/// Calls visit(TextureSlot&) for every slot of a material.
template <typename M, typename Visit>
void for_each_slot(M& m, const Visit& visit) {
  visit(m.base_color_texture);
  visit(m.metallic_roughness_texture);
  visit(m.normal_texture);
  visit(m.emission_texture);
  visit(m.specular_texture);
  visit(m.specular_color_texture);
  visit(m.glossiness_texture);
  visit(m.iridescence_texture);
  visit(m.film_thickness_texture);
  visit(m.anisotropy_texture);
  visit(m.transmission_texture);
  visit(m.diffuse_transmission_texture);
  visit(m.diffuse_transmission_color_texture);
  visit(m.clearcoat_texture);
  visit(m.clearcoat_roughness_texture);
  visit(m.clearcoat_normal_texture);
  visit(m.sheen_color_texture);
  visit(m.sheen_roughness_texture);
}

}  // namespace gatelight::scene::gltf
