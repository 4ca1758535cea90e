#pragma once
// The texture slots of a material, one after the other.

#include "scene/scene.h"

namespace gatelight::scene {

/// Calls visit(slot, is_color) for every slot. Colours are sRGB in the file, everything else is linear.
template <typename M, typename Visit>
void for_each_slot(M& m, const Visit& visit) {
  visit(m.base_color_texture, true);
  visit(m.metallic_roughness_texture, false);
  visit(m.normal_texture, false);
  visit(m.emission_texture, true);
  visit(m.specular_texture, false);
  visit(m.specular_color_texture, true);
  visit(m.glossiness_texture, true);
  visit(m.transmission_texture, false);
  visit(m.anisotropy_texture, false);
  visit(m.iridescence_texture, false);
  visit(m.film_thickness_texture, false);
  visit(m.clearcoat_texture, false);
  visit(m.clearcoat_roughness_texture, false);
  visit(m.clearcoat_normal_texture, false);
  visit(m.diffuse_transmission_texture, false);
  visit(m.diffuse_transmission_color_texture, true);
  visit(m.sheen_color_texture, true);
  visit(m.sheen_roughness_texture, false);
}

/// Whether the slot, one of the material's, holds a normal map.
inline bool is_normal_map(const Material& m, const TextureSlot& slot) {
  return &slot == &m.normal_texture || &slot == &m.clearcoat_normal_texture;
}

}  // namespace gatelight::scene
