#include "scene/gltf/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gatelight::scene::gltf {
namespace {

constexpr std::array<std::string_view, 16> kSupported = {
    "EXT_mesh_gpu_instancing",    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression", "KHR_lights_punctual",
    "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_sheen",
    "KHR_materials_specular",     "KHR_materials_transmission",
    "KHR_materials_unlit",        "KHR_materials_variants",
    "KHR_materials_volume",       "KHR_mesh_quantization",
    "KHR_texture_transform",      "KHR_materials_pbrSpecularGlossiness"};

bool is_supported(std::string_view name) {
  return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
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

const json* find_extension(const json& object, const char* name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end()) return nullptr;
  const auto found = extensions->find(name);
  return found == extensions->end() ? nullptr : &*found;
}

}  // namespace gatelight::scene::gltf
