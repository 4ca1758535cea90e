#include "scene/gltf/extensions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf/schema.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// Supported ones without a member of their own.
constexpr std::string_view kWithoutMembers[] = {"KHR_animation_pointer", "KHR_mesh_quantization"};

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

/// Whether the schema knows it. For KHR_texture_basisu and MSFT_texture_dds only the fallback picture of a
/// texture is read.
bool is_supported(std::string_view name) {
  const auto has = [&](const Rule& rule) { return rule.owner.ends_with(".extensions") && rule.name == name; };
  const std::span<const Rule> rules = schema_rules();
  return is_one_of(kWithoutMembers, name) || std::any_of(rules.begin(), rules.end(), has);
}

}  // namespace

void check_extensions(const json& root, const std::vector<std::string>& ignored, std::string_view file,
                      Warnings& warnings) {
  const json required = root.value("extensionsRequired", json::array());
  std::vector<std::string> missing;
  for (const std::string name : required) {
    const bool passes = is_supported(name) || is_one_of(kHarmless, name) ||
                        std::find(ignored.begin(), ignored.end(), name) != ignored.end();
    if (!passes) missing.push_back(name);
  }
  if (!missing.empty()) {
    throw make_error(
        file, "extensionsRequired",
        fmt::format("{} {} not supported, expected only supported extensions (`ignore-required` {} "
                    "renders without {})",
                    fmt::join(missing, ", "), missing.size() > 1 ? "are" : "is", fmt::join(missing, ","),
                    missing.size() > 1 ? "them" : "it"));
  }
  std::vector<std::string> left;
  for (const json& names : {required, root.value("extensionsUsed", json::array())}) {
    for (const std::string name : names) {
      if (!is_supported(name) && std::find(left.begin(), left.end(), name) == left.end())
        left.push_back(name);
    }
  }
  if (left.size() == 1)
    warnings.add(fmt::format("the extension {} is not supported; it is ignored", left.front()));
  if (left.size() > 1)
    warnings.add(fmt::format("the extensions {} are not supported; they are ignored", fmt::join(left, ", ")));
}

}  // namespace gatelight::scene::gltf
