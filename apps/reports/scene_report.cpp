#include "apps/reports/scene_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/reports/visibility_report.h"
#include "apps/settings/parsing.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"
#include "renderer/film/memory_estimate.h"
#include "scene/material_fields.h"
#include "scene/nested_volumes.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using scene::SceneRequirements;

struct NamedRequirement {
  const char* key;
  bool SceneRequirements::*flag;
};
constexpr NamedRequirement kRequirements[] = {
    {"two_sided", &SceneRequirements::two_sided},
    {"view_dependent", &SceneRequirements::view_dependent},
    {"alpha_mask", &SceneRequirements::alpha_mask},
    {"alpha_blend", &SceneRequirements::alpha_blend},
    {"transmission", &SceneRequirements::transmission},
    {"volumes", &SceneRequirements::volumes},
    {"nested_volumes", &SceneRequirements::nested_volumes},
    {"dispersion", &SceneRequirements::dispersion},
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
    {"image_light", &SceneRequirements::image_light},
};

const char* name_of_type(const scene::Camera& camera) {
  return camera.orthographic ? "orthographic" : "perspective";
}

class SceneRows {
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

/// Unit of an intensity. The file's numbers are not converted (KHR_lights_punctual has candela and lux).
const char* unit_of(const scene::PunctualLight& light) {
  return light.type == scene::LightType::directional ? "W/m2" : "W/sr";
}

std::vector<std::string> describe_lights(const scene::Scene& scene, const SceneRequirements& requirements) {
  std::vector<std::string> lines;
  for (const scene::PunctualLight& light : scene.lights) {
    lines.push_back(fmt::format("{} '{}', intensity {:.4g} {:.4g} {:.4g} {}",
                                renderer::name_of(kLightTypes, light.type), light.name, light.intensity.x(),
                                light.intensity.y(), light.intensity.z(), unit_of(light)));
  }
  if (!scene.lights.empty()) lines.emplace_back("(the file's numbers, not converted from candela and lux)");
  if (scene.image_light) {
    const scene::ImageBasedLight& light = *scene.image_light;
    lines.push_back(fmt::format("environment '{}', faces of {}x{}, intensity {:.4g}", light.name,
                                light.faces[0].width, light.faces[0].height, light.intensity));
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
                                 : fmt::format("{:.4g} degrees", camera.vertical_fov * 180.0f / kPi);
    const std::string node =
        camera.node.empty() || camera.node == camera.name ? "" : fmt::format(", node '{}'", camera.node);
    lines.push_back(fmt::format("{} '{}'{}, {}, {}", i, camera.name, node, name_of_type(camera), lens));
  }
  return lines;
}

std::vector<std::string> describe_animations(const scene::Scene& scene) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scene.animations.size(); ++i) {
    const scene::Animation& animation = scene.animations[i];
    const std::string length =
        animation.seconds > 0.0 ? fmt::format(", {:.4g} s", animation.seconds) : std::string();
    lines.push_back(fmt::format("{} '{}'{}", i, animation.name, length));
  }
  return lines;
}

/// Metres between events inside a material, on average.
Color mean_free_path(const scene::Material& m) {
  return m.attenuation_distance / -m.attenuation_color.max(1e-30f).log();
}

/// The bodies of glass and liquid that overlap, the strongest first.
std::vector<const scene::Instance*> nested_media(const scene::Scene& scene,
                                                 const SceneRequirements& requirements) {
  std::vector<const scene::Instance*> media;
  if (!requirements.nested_volumes) return media;
  for (const std::uint32_t instance : scene::find_nested_volumes(scene).instances)
    media.push_back(&scene.instances[instance]);
  return media;
}

std::vector<std::string> describe_media(const scene::Scene& scene, const SceneRequirements& requirements) {
  constexpr std::size_t kMaxLines = 20;
  std::vector<std::string> lines;
  for (const scene::Instance* instance : nested_media(scene, requirements)) {
    if (lines.size() == kMaxLines) {
      lines.emplace_back("...");
      break;
    }
    lines.push_back(fmt::format("'{}', ior {:.4g}, priority {:.4g}", instance->name,
                                scene.material_of(*instance).ior, instance->dielectric_priority));
  }
  lines.emplace_back("(overlapping bodies, the one with the highest priority first)");
  return lines;
}

/// The materials whose inside scatters light.
std::vector<std::string> describe_scattering(const scene::Scene& scene) {
  std::vector<std::string> lines;
  for (const scene::Material& m : scene.materials) {
    if (!m.scatters()) continue;
    const Color path = mean_free_path(m) * 1e3f;
    lines.push_back(fmt::format(
        "'{}', mean free path {:.3g}, {:.3g}, {:.3g} mm, colour {:.3g}, {:.3g}, {:.3g}", m.name, path[0],
        path[1], path[2], m.multiscatter_color[0], m.multiscatter_color[1], m.multiscatter_color[2]));
  }
  return lines;
}

ordered_json triple(const Vec3& v) {
  return {shortest(v.x()), shortest(v.y()), shortest(v.z())};
}

double degrees(double radians) {
  return radians * 180.0 / static_cast<double>(kPi);
}

/// Places are in the file's coordinates.
ordered_json light_json(const scene::PunctualLight& light, const Vec3& origin) {
  using scene::LightType;
  ordered_json json = {{"name", light.name},
                       {"type", renderer::name_of(kLightTypes, light.type)},
                       {"intensity", triple(light.intensity.matrix())},
                       {"unit", unit_of(light)}};
  if (light.type != LightType::directional) json["position"] = triple(light.position + origin);
  if (light.type != LightType::point) json["direction"] = triple(light.direction);
  if (light.type != LightType::directional)
    json["range"] = std::isfinite(light.range) ? ordered_json(shortest(light.range)) : ordered_json();
  if (light.type == LightType::spot) {
    json["inner_cone_degrees"] = degrees(std::acos(static_cast<double>(light.cos_inner)));
    json["outer_cone_degrees"] = degrees(std::acos(static_cast<double>(light.cos_outer)));
  }
  return json;
}

ordered_json camera_json(const scene::Camera& camera, const Vec3& origin) {
  ordered_json json = {{"name", camera.name}, {"node", camera.node}, {"type", name_of_type(camera)}};
  if (camera.orthographic) {
    json["height"] = 2.0 * shortest(camera.half_height);
    if (camera.half_width > 0.0f) json["width"] = 2.0 * shortest(camera.half_width);
  } else {
    json["vertical_fov_degrees"] = degrees(shortest(camera.vertical_fov));
  }
  if (camera.aspect > 0.0f) json["aspect"] = shortest(camera.aspect);
  Affine placed = camera.transform;
  placed.translation() += origin;
  json["transform"] = ordered_json::array();
  for (Eigen::Index column = 0; column < 4; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row)
      json["transform"].push_back(shortest(placed.matrix()(row, column)));
    json["transform"].push_back(column == 3 ? 1.0 : 0.0);
  }
  return json;
}

/// The bounds in the file's coordinates.
Box file_bounds(const scene::Scene& scene) {
  Box bounds = scene.bounds;
  if (!bounds.isEmpty()) bounds.translate(scene.origin);
  return bounds;
}

std::string describe_bounds(const Box& bounds) {
  if (bounds.isEmpty()) return "empty";
  const Vec3& low = bounds.min();
  const Vec3& high = bounds.max();
  return fmt::format("{:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g} m, diagonal {:.4g} m", low.x(), low.y(),
                     low.z(), high.x(), high.y(), high.z(), (high - low).norm());
}

std::string describe_requirements(const SceneRequirements& requirements) {
  std::vector<std::string_view> names;
  for (const NamedRequirement& requirement : kRequirements) {
    if (requirements.*requirement.flag) names.emplace_back(requirement.key);
  }
  for (const scene::MaterialLobe& lobe : scene::material_lobes()) {
    if (requirements.has_lobe(lobe.name)) names.push_back(lobe.name);
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
  SceneRows rows;
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
  if (!scene.animations.empty()) rows.add_list("animations", describe_animations(scene));
  if (requirements.nested_volumes) rows.add_list("nested media", describe_media(scene, requirements));
  if (const std::vector<std::string> media = describe_scattering(scene); !media.empty())
    rows.add_list("scattering", media);
  if (const std::vector<std::string> lines = describe_visibility(scene); !lines.empty())
    rows.add_list("visibility", lines);
  if (const std::vector<std::string> lines = describe_light_links(scene); !lines.empty())
    rows.add_list("light links", lines);
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
  const auto rgb = [](const Color& c) { return ordered_json{c.x(), c.y(), c.z()}; };
  json["lights"] = ordered_json::array();
  for (const scene::PunctualLight& light : scene.lights) {
    json["lights"].push_back(light_json(light, scene.origin));
  }
  if (scene.image_light) {
    const scene::ImageBasedLight& light = *scene.image_light;
    json["image_light"] = {
        {"name", light.name}, {"face_size", light.faces[0].width}, {"intensity", shortest(light.intensity)}};
  }
  json["emissive_materials"] = ordered_json::array();
  for (const scene::Material& material : scene.materials) {
    if (material.emits())
      json["emissive_materials"].push_back({{"name", material.name}, {"emission", rgb(material.emission)}});
  }
  json["nested_media"] = ordered_json::array();
  for (const scene::Instance* instance : nested_media(scene, requirements)) {
    json["nested_media"].push_back({{"name", instance->name},
                                    {"ior", shortest(scene.material_of(*instance).ior)},
                                    {"priority", shortest(instance->dielectric_priority)}});
  }
  json["visibility"] = visibility_json(scene);
  json["light_links"] = light_links_json(scene);
  json["cameras"] = ordered_json::array();
  for (const scene::Camera& camera : scene.cameras) {
    json["cameras"].push_back(camera_json(camera, scene.origin));
  }
  json["variants"] = scene.variants;
  json["animations"] = ordered_json::array();
  for (const scene::Animation& animation : scene.animations)
    json["animations"].push_back({{"name", animation.name}, {"seconds", animation.seconds}});
  if (!scene.bounds.isEmpty()) {
    const Box bounds = file_bounds(scene);
    json["bounds"] = {{"min", triple(bounds.min())}, {"max", triple(bounds.max())}};
  }
  for (const NamedRequirement& requirement : kRequirements) {
    json["requirements"][requirement.key] = requirements.*requirement.flag;
  }
  for (const scene::MaterialLobe& lobe : scene::material_lobes())
    json["requirements"][std::string(lobe.name)] = requirements.has_lobe(lobe.name);
  json["requirements"]["emissive_triangles"] = requirements.emissive_triangles;
  json["requirements"]["emissive_materials"] = requirements.emissive_materials;
  json["memory_bytes"] = {{"geometry", scene::geometry_bytes(scene)},
                          {"images", scene::image_bytes(scene)},
                          {"render_estimate", render_bytes(scene)}};
  json["seconds"] = {{"load", load_seconds}};
  json["warnings"] = ordered_json::array();
  for (const std::string& warning : scene.warnings) json["warnings"].push_back(with_flags(warning));
  return json;
}

}  // namespace gatelight::apps
