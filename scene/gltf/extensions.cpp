#include "scene/gltf/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// For KHR_texture_basisu and MSFT_texture_dds only the fallback picture of a texture is read.
constexpr std::string_view kSupported[] = {
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
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

bool is_supported(std::string_view name) {
  return std::find(std::begin(kSupported), std::end(kSupported), name) != std::end(kSupported);
}

}  // namespace

void check_extensions(const json& root, std::string_view file, Warnings& warnings) {
  for (const std::string name : root.value("extensionsRequired", json::array())) {
    if (!is_supported(name)) {
      throw make_error(file, "extensionsRequired",
                       fmt::format("{} is not supported, expected only supported extensions", name));
    }
  }
  for (const std::string name : root.value("extensionsUsed", json::array())) {
    if (!is_supported(name)) {
      warnings.add(fmt::format("extensionsUsed: {} is not supported and ignored", name));
    }
  }
}

}  // namespace gatelight::scene::gltf
