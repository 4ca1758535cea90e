#include "apps/reports/scene_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/settings/values.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using scene::SceneRequirements;

struct Requirement {
  const char* key;
  bool SceneRequirements::*flag;
};
constexpr Requirement kRequirements[] = {
    {"two_sided", &SceneRequirements::two_sided},
    {"view_dependent", &SceneRequirements::view_dependent},
    {"alpha_mask", &SceneRequirements::alpha_mask},
    {"alpha_blend", &SceneRequirements::alpha_blend},
    {"transmission", &SceneRequirements::transmission},
    {"volumes", &SceneRequirements::volumes},
    {"clearcoat", &SceneRequirements::clearcoat},
    {"sheen", &SceneRequirements::sheen},
    {"unlit", &SceneRequirements::unlit},
    {"normal_maps", &SceneRequirements::normal_maps},
    {"vertex_colors", &SceneRequirements::vertex_colors},
    {"base_color_textures", &SceneRequirements::base_color_textures},
    {"metallic_roughness_textures", &SceneRequirements::metallic_roughness_textures},
    {"emission_textures", &SceneRequirements::emission_textures},
    {"other_textures", &SceneRequirements::other_textures},
    {"instances", &SceneRequirements::instances},
    {"delta_lights", &SceneRequirements::delta_lights},
    {"directional_lights", &SceneRequirements::directional_lights},
};

constexpr renderer::Choice<scene::LightType> kLightTypes[] = {{"directional", scene::LightType::directional},
                                                              {"point", scene::LightType::point},
                                                              {"spot", scene::LightType::spot}};

const char* name_of_type(const scene::Camera& camera) {
  return camera.orthographic ? "orthographic" : "perspective";
}

class Rows {
 public:
  /// Names in the file may hold anything; control characters must not reach the terminal.
  void add(const std::string& name, const std::string& value) {
    text_ += fmt::format("{:<14} {}\n", name, one_line(value));
  }

  /// Puts the first entry beside the name and the others below it.
  void add_list(const std::string& name, const std::vector<std::string>& entries) {
    if (entries.empty()) add(name, "none");
    for (std::size_t i = 0; i < entries.size(); ++i) add(i == 0 ? name : "", entries[i]);
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::vector<std::string> describe_lights(const scene::Scene& scene, const SceneRequirements& requirements) {
  std::vector<std::string> lines;
  for (const scene::PunctualLight& light : scene.lights) {
    lines.push_back(fmt::format("{} '{}', intensity {:.4g} {:.4g} {:.4g}",
                                renderer::name_of(kLightTypes, light.type), light.name, light.intensity.x(),
                                light.intensity.y(), light.intensity.z()));
  }
  if (requirements.emissive_triangles > 0) {
    lines.push_back(fmt::format("{} emissive triangles of {} materials",
                                format_integer(requirements.emissive_triangles),
                                requirements.emissive_materials));
  }
  for (const scene::Material& material : scene.materials) {
    if (!material.emits()) continue;
    lines.push_back(fmt::format("material '{}', emission {:.4g} {:.4g} {:.4g}", material.name,
                                material.emission.x(), material.emission.y(), material.emission.z()));
  }
  return lines;
}

std::vector<std::string> describe_cameras(const scene::Scene& scene) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const scene::Camera& camera = scene.cameras[i];
    const std::string lens = camera.orthographic
                                 ? fmt::format("{:.4g} m high", 2.0f * camera.half_height)
                                 : fmt::format("{:.4g} degrees", camera.vertical_fov * 180.0f / scene::kPi);
    lines.push_back(fmt::format("{} '{}', {}, {}", i, camera.name, name_of_type(camera), lens));
  }
  return lines;
}

/// The bounds in the file's coordinates.
scene::Box file_bounds(const scene::Scene& scene) {
  scene::Box bounds = scene.bounds;
  if (!bounds.isEmpty()) bounds.translate(scene.origin);
  return bounds;
}

std::string describe_bounds(const scene::Box& bounds) {
  if (bounds.isEmpty()) return "empty";
  const scene::Vec3& low = bounds.min();
  const scene::Vec3& high = bounds.max();
  return fmt::format("{:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g} m, diagonal {:.4g} m", low.x(), low.y(),
                     low.z(), high.x(), high.y(), high.z(), (high - low).norm());
}

std::string describe_requirements(const SceneRequirements& requirements) {
  std::vector<std::string_view> names;
  for (const Requirement& requirement : kRequirements) {
    if (requirements.*requirement.flag) names.emplace_back(requirement.key);
  }
  return names.empty() ? "nothing special" : fmt::format("{}", fmt::join(names, ", "));
}

std::size_t stored_triangles(const scene::Scene& scene) {
  std::size_t triangles = 0;
  for (const scene::Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  return triangles;
}

/// Estimate for a picture with the default options, in bytes.
std::size_t render_bytes(const scene::Scene& scene) {
  return renderer::estimate_memory(scene, renderer::RenderOptions()).total();
}

}  // namespace

std::string scene_report_text(const scene::Scene& scene, const SceneRequirements& requirements,
                              double load_seconds) {
  Rows rows;
  rows.add("scene", scene.path);
  rows.add("triangles", fmt::format("{} stored, {} with instances", format_integer(stored_triangles(scene)),
                                    format_integer(scene::count_triangles(scene))));
  rows.add("meshes", format_integer(scene.meshes.size()));
  rows.add("instances", format_integer(scene.instances.size()));
  rows.add("materials", format_integer(scene.materials.size()));
  rows.add("textures", fmt::format("{} of {} images", scene.textures.size(), scene.images.size()));
  rows.add_list("lights", describe_lights(scene, requirements));
  rows.add_list("cameras", describe_cameras(scene));
  rows.add_list("variants", scene.variants);
  rows.add("bounds", describe_bounds(file_bounds(scene)));
  rows.add("requires", describe_requirements(requirements));
  rows.add("memory", fmt::format("geometry {}, images {}; rendering with default options needs about {}",
                                 format_bytes(scene::geometry_bytes(scene)),
                                 format_bytes(scene::image_bytes(scene)), format_bytes(render_bytes(scene))));
  rows.add("loaded in", fmt::format("{:.2f} s", load_seconds));
  return rows.text();
}

ordered_json scene_report_json(const scene::Scene& scene, const SceneRequirements& requirements,
                               double load_seconds) {
  ordered_json json;
  json["schema"] = 1;
  json["scene"] = scene.path;
  json["triangles_stored"] = stored_triangles(scene);
  json["triangles"] = scene::count_triangles(scene);
  json["meshes"] = scene.meshes.size();
  json["instances"] = scene.instances.size();
  json["materials"] = scene.materials.size();
  json["textures"] = scene.textures.size();
  json["images"] = scene.images.size();
  const auto rgb = [](const scene::Color& c) { return ordered_json{c.x(), c.y(), c.z()}; };
  json["lights"] = ordered_json::array();
  for (const scene::PunctualLight& light : scene.lights) {
    json["lights"].push_back({{"name", light.name},
                              {"type", renderer::name_of(kLightTypes, light.type)},
                              {"intensity", rgb(light.intensity)}});
  }
  json["emissive_materials"] = ordered_json::array();
  for (const scene::Material& material : scene.materials) {
    if (material.emits())
      json["emissive_materials"].push_back({{"name", material.name}, {"emission", rgb(material.emission)}});
  }
  json["cameras"] = ordered_json::array();
  for (const scene::Camera& camera : scene.cameras) {
    json["cameras"].push_back({{"name", camera.name}, {"type", name_of_type(camera)}});
  }
  json["variants"] = scene.variants;
  if (!scene.bounds.isEmpty()) {
    const auto triple = [](const scene::Vec3& v) { return ordered_json{v.x(), v.y(), v.z()}; };
    const scene::Box bounds = file_bounds(scene);
    json["bounds"] = {{"min", triple(bounds.min())}, {"max", triple(bounds.max())}};
  }
  for (const Requirement& requirement : kRequirements) {
    json["requirements"][requirement.key] = requirements.*requirement.flag;
  }
  json["requirements"]["emissive_triangles"] = requirements.emissive_triangles;
  json["requirements"]["emissive_materials"] = requirements.emissive_materials;
  json["memory_bytes"] = {{"geometry", scene::geometry_bytes(scene)},
                          {"images", scene::image_bytes(scene)},
                          {"render_estimate", render_bytes(scene)}};
  json["seconds"] = {{"load", load_seconds}};
  json["warnings"] = scene.warnings;
  return json;
}

}  // namespace gatelight::apps
