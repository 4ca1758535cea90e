#include "scene/requirements.h"

#include <algorithm>

#include "scene/material_fields.h"
#include "scene/nested_volumes.h"

namespace gatelight::scene {
namespace {

/// Whether the material has a lobe other than Lambert's. A dielectric with an index of refraction of 1 does
/// not reflect.
bool is_view_dependent(const Material& m) {
  if (m.unlit) return false;
  if (m.metallic > 0.0f || (m.specular > 0.0f && m.ior != 1.0f) || m.transmission > 0.0f) return true;
  const auto lobes = material_lobes();
  return std::any_of(lobes.begin(), lobes.end(), [&](const MaterialLobe& lobe) {
    return lobe.view_dependent && is_used(m, lobe.extension);
  });
}

void add_material(const Material& m, SceneRequirements& r) {
  r.two_sided |= m.double_sided && !m.transmits();
  r.view_dependent |= is_view_dependent(m);
  r.alpha_mask |= m.alpha_mode == AlphaMode::mask;
  r.alpha_blend |= m.alpha_mode == AlphaMode::blend;
  r.transmission |= m.transmits();
  r.volumes |= m.has_volume();
  r.dispersion |= m.disperses();
  r.sheen |= (m.sheen_color > 0.0f).any();
  for (const MaterialLobe& lobe : material_lobes()) {
    if (!r.has_lobe(lobe.name) && is_used(m, lobe.extension)) r.lobes.push_back(lobe.name);
  }
  r.unlit |= m.unlit;
  r.normal_maps |= m.normal_texture || (m.clearcoat > 0.0f && m.clearcoat_normal_texture);
  r.base_color_textures |= static_cast<bool>(m.base_color_texture);
  r.metallic_roughness_textures |= static_cast<bool>(m.metallic_roughness_texture);
  r.emission_textures |= m.emits() && m.emission_texture;
  for_each_slot(m, [&](const TextureSlot& slot, bool) {
    const bool of_the_core = &slot == &m.base_color_texture || &slot == &m.metallic_roughness_texture ||
                             &slot == &m.normal_texture || &slot == &m.emission_texture;
    r.other_textures |= slot && !of_the_core;
  });
  if (m.emits()) ++r.emissive_materials;
}

}  // namespace

SceneRequirements compute_requirements(const Scene& scene) {
  SceneRequirements r;
  std::vector<char> used(scene.materials.size(), 0);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.mesh_of(instance);
    if (mesh.triangles.empty()) continue;
    r.triangles = true;
    r.instances |= !instance.baked;
    r.vertex_colors |= !mesh.colors.empty();
    used[static_cast<std::size_t>(mesh.material)] = 1;
    if (scene.material_of(instance).emits()) r.emissive_triangles += mesh.triangles.size();
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) add_material(scene.materials[i], r);
  }
  r.nested_volumes = r.volumes && !find_nested_volumes(scene).empty();
  r.delta_lights = !scene.lights.empty();
  r.image_light = scene.image_light.has_value();
  r.directional_lights =
      std::any_of(scene.lights.begin(), scene.lights.end(),
                  [](const PunctualLight& light) { return light.type == LightType::directional; });
  return r;
}

}  // namespace gatelight::scene
