#pragma once
// What a scene needs of the renderer and of the cache. Computed once after loading; later stages read it and
// build nothing else.

#include <cstddef>

#include "scene/scene.h"

namespace gatelight::scene {

struct SceneRequirements {
  bool triangles = false;
  bool two_sided = false;       ///< some opaque surface shows its back: doubleSided
  bool view_dependent = false;  ///< reflected light depends on the direction of view (any lobe but Lambert's)
  bool alpha_mask = false;
  bool alpha_blend = false;
  bool transmission = false;
  bool volumes = false;  ///< transmission into an interior, with absorption
  bool clearcoat = false;
  bool sheen = false;
  bool unlit = false;
  bool normal_maps = false;
  bool vertex_colors = false;
  bool base_color_textures = false;
  bool metallic_roughness_textures = false;
  bool emission_textures = false;
  bool other_textures = false;  ///< of the extensions
  bool instances = false;       ///< some mesh is drawn through an Embree instance
  bool delta_lights = false;    ///< punctual lights of any kind
  bool directional_lights = false;
  std::size_t emissive_triangles = 0;  ///< each instance counted
  std::size_t emissive_materials = 0;

  /// Whether rays need an alpha test at all.
  bool alpha() const { return alpha_mask || alpha_blend; }
};

SceneRequirements compute_requirements(const Scene& scene);

}  // namespace gatelight::scene
