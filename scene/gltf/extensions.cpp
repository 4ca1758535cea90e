#include "scene/gltf/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// For KHR_texture_basisu and MSFT_texture_dds only the fallback picture of a texture is read.
constexpr std::string_view kSupported[] = {
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "MSFT_texture_dds",
};

/// Unsupported ones that no still picture needs: physics, sound, interaction, other data about the
/// scene, levels of detail, and hints.
constexpr std::string_view kHarmless[] = {
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "KHR_audio_emitter",
    "KHR_collision_shapes",
    "KHR_implicit_shapes",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
};

bool is_one_of(std::span<const std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void check_extensions(const json& root, const std::vector<std::string>& ignored, std::string_view file,
                      Warnings& warnings) {
  const json required = root.value("extensionsRequired", json::array());
  for (const std::string name : required) {
    const bool passes = is_one_of(kSupported, name) || is_one_of(kHarmless, name) ||
                        std::find(ignored.begin(), ignored.end(), name) != ignored.end();
    if (!passes) {
      throw make_error(
          file, "extensionsRequired",
          fmt::format("{} is not supported, expected only supported extensions (`ignore-required` "
                      "renders without it)",
                      name));
    }
  }
  for (const json& names : {required, root.value("extensionsUsed", json::array())}) {
    for (const std::string name : names) {
      if (!is_one_of(kSupported, name))
        warnings.add(fmt::format("the extension {} is not supported and ignored", name));
    }
  }
}

}  // namespace gatelight::scene::gltf
