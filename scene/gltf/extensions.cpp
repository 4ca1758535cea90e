#include "scene/gltf/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gatelight::scene::gltf {
namespace {

constexpr std::array<std::string_view, 15> kSupported = {
    "EXT_mesh_gpu_instancing",    "EXT_meshopt_compression", "KHR_draco_mesh_compression",
    "KHR_lights_punctual",        "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_sheen",     "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_unlit",     "KHR_materials_variants",
    "KHR_materials_volume",       "KHR_mesh_quantization",   "KHR_texture_transform"};

bool is_supported(std::string_view name) {
  return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

}  // namespace

void check_extensions(const tinygltf::Model& model, std::string_view file, Warnings& warnings) {
  for (const std::string& name : model.extensionsRequired) {
    if (!is_supported(name)) {
      throw make_error(file, "extensionsRequired",
                       fmt::format("{} is not supported, expected only supported extensions", name));
    }
  }
  for (const std::string& name : model.extensionsUsed) {
    if (!is_supported(name)) {
      warnings.add(fmt::format("extensionsUsed: {} is not supported and ignored", name));
    }
  }
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
  const auto found = extensions.find(name);
  return found == extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
}

double number_or(const tinygltf::Value& object, const std::string& name, double fallback) {
  if (!object.Has(name)) return fallback;
  const tinygltf::Value& value = object.Get(name);
  return value.IsNumber() ? value.GetNumberAsDouble() : fallback;
}

int integer_or(const tinygltf::Value& object, const std::string& name, int fallback) {
  if (!object.Has(name)) return fallback;
  const tinygltf::Value& value = object.Get(name);
  return value.IsNumber() ? value.GetNumberAsInt() : fallback;
}

std::string text_or(const tinygltf::Value& object, const std::string& name, const std::string& fallback) {
  if (!object.Has(name)) return fallback;
  const tinygltf::Value& value = object.Get(name);
  return value.IsString() ? value.Get<std::string>() : fallback;
}

}  // namespace gatelight::scene::gltf
