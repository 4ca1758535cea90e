#pragma once
// The features that a scene needs from the renderer and the cache. They are computed once after loading;
// later stages build only what is listed here.

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

struct SceneRequirements {
  bool triangles = false;
  bool two_sided = false;       ///< some material without transmission is doubleSided
  bool view_dependent = false;  ///< some material has a lobe other than Lambert's
  bool alpha_mask = false;
  bool alpha_blend = false;
  bool transmission = false;
  bool volumes = false;         ///< transmission into an interior with absorption
  bool nested_volumes = false;  ///< volumes overlap, or lie inside one another (nested_volumes.h)
  bool dispersion = false;
  bool sheen = false;  ///< its tables take a while to build
  bool unlit = false;
  bool normal_maps = false;
  bool vertex_colors = false;
  bool base_color_textures = false;
  bool metallic_roughness_textures = false;
  bool emission_textures = false;
  bool other_textures = false;  ///< textures of material extensions
  bool instances = false;       ///< some mesh is an Embree instance
  bool delta_lights = false;    ///< punctual lights of any kind
  bool image_light = false;     ///< an environment of its own
  bool directional_lights = false;
  std::size_t emissive_triangles = 0;  ///< counted once per instance
  std::size_t emissive_materials = 0;
  std::vector<std::string_view> lobes;  ///< names of the material_lobes() that some material has

  /// Whether rays need an alpha test.
  bool alpha() const { return alpha_mask || alpha_blend; }
  bool has_lobe(std::string_view name) const {
    return std::find(lobes.begin(), lobes.end(), name) != lobes.end();
  }
};

SceneRequirements compute_requirements(const Scene& scene);

}  // namespace gatelight::scene
