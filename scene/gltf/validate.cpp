#include "scene/gltf/validate.h"

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/animation_choice.h"
#include "scene/gltf/extensions.h"
#include "scene/gltf/references.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/unchecked.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// JSON libraries recurse. No valid glTF is nested this deep.
constexpr int kMaxDepth = 100;

void check_depth(std::string_view text, std::string_view file) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxDepth) {
        throw make_error(file, "JSON", fmt::format("nested deeper than {}, expected glTF", kMaxDepth));
      }
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

json parse_json(std::string_view text, std::string_view file) {
  // The specification requires spaces as padding, but some exporters write zero bytes.
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  check_depth(text, file);
  try {
    json root = json::parse(text);
    if (!root.is_object()) throw make_error(file, "JSON", "not an object, expected a glTF object");
    return root;
  } catch (const json::exception& e) {
    std::string_view what = e.what();
    if (const std::size_t end = what.find("] "); end != std::string_view::npos) what.remove_prefix(end + 2);
    throw make_error(file, "JSON", fmt::format("{}, expected a glTF object", what));
  }
}

/// Accepts "2", and "2." with digits: the specification keeps minor versions compatible.
bool is_version_2(std::string_view version) {
  return version == "2" || (version.size() > 2 && version.starts_with("2.") &&
                            version.find_first_not_of("0123456789", 2) == std::string_view::npos);
}

/// The version that a file says it has.
std::optional<std::string> said_version(const json& asset) {
  const auto version = asset.find("version");
  if (version == asset.end()) return std::nullopt;
  if (version->is_number()) return fmt::format("{:.1f}", version->get<double>());
  return version->is_string() ? std::optional(version->get<std::string>()) : std::nullopt;
}

/// Before all else: lists of other versions have another form.
void check_version(json& root, std::string_view file, Warnings& warnings) {
  json& asset = root["asset"];
  if (!asset.is_object()) asset = json::object();
  const std::optional<std::string> version = said_version(asset);
  if (version && !is_version_2(*version)) {
    const char* const help =
        version->starts_with('1') ? " ('assimp export FILE.gltf NEW.glb -f glb2' converts it)" : "";
    throw make_error(file, "asset.version", fmt::format("'{}', expected 2.0{}", *version, help));
  }
  if (!asset.contains("version") || !asset["version"].is_string()) {
    if (!root.contains("nodes")) throw make_error(file, "asset.version", "missing, expected glTF 2.0");
    warnings.add("asset.version: missing; 2.0 is assumed");
    asset["version"] = "2.0";
  }
  const auto least = asset.find("minVersion");
  if (least != asset.end() && *least != "2.0") {
    throw make_error(
        file, "asset.minVersion",
        fmt::format("{}, expected 2.0", least->dump(-1, ' ', false, json::error_handler_t::replace)));
  }
}

/// A file without scenes shows all its nodes.
void add_scene(json& root, Warnings& warnings) {
  if (!list_of(root, "scenes").empty() || list_of(root, "nodes").empty()) return;
  const std::vector<std::size_t> parents = parents_of(root["nodes"]);
  json roots = json::array();
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == kNoParent) roots.push_back(i);
  }
  root["scenes"] = json::array({{{"nodes", std::move(roots)}}});
  warnings.add("the file has no scene; all its nodes are shown");
}

/// Members of cameras and lights that depend on their type, which the schema's table cannot express. tinygltf
/// wants some that no picture needs.
void complete_cameras(json& root, std::string_view file) {
  if (!root.contains("cameras")) return;
  json& cameras = root["cameras"];
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string type = cameras[i]["type"];
    if (!cameras[i].contains(type)) {
      throw make_error(file, fmt::format("cameras[{}]", i), fmt::format("no {}, expected one", type));
    }
    for (const char* plane : {"znear", "zfar"}) {
      if (!cameras[i][type].contains(plane)) cameras[i][type][plane] = 0.0;
    }
  }
}

void complete_lights(json& root, Warnings& warnings) {
  const json::json_pointer place("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(place)) return;
  json& lights = root.at(place);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    json& type = lights[i]["type"];
    if (type.is_null()) type = "unknown";
    if (type != "spot" || lights[i].contains("spot")) continue;
    warnings.add(fmt::format("extensions.KHR_lights_punctual.lights[{}]: no spot; the defaults are used", i));
    lights[i]["spot"] = json::object();
  }
}

/// tinygltf drops empty objects and lists, but a set of no object differs from a missing one.
void complete_links(json& root) {
  for (const char* list : {"nodes", "scenes"}) {
    if (!root.contains(list)) continue;
    for (json& owner : root[list]) {
      const json::json_pointer place("/extensions/GATELIGHT_light_linking");
      if (!owner.contains(place)) continue;
      for (json& objects : owner[place]) objects.emplace("exclude", false);
    }
  }
}

void check_views(json& root, std::string_view file, Warnings& warnings) {
  if (!root.contains("bufferViews")) return;
  json& views = root["bufferViews"];
  for (std::size_t i = 0; i < views.size(); ++i) {
    json& view = views[i];
    const std::string where = fmt::format("bufferViews[{}]", i);
    const std::size_t size = view["byteLength"];
    if (view.contains("byteStride")) {
      const std::size_t stride = view["byteStride"];
      if (stride == 0) {
        warnings.add(fmt::format("{}: byteStride 0; it is ignored", where));
        view.erase("byteStride");
      } else if (stride % 4 != 0 || stride > 252) {
        warnings.add(fmt::format("{}: byteStride {}, expected a multiple of 4 up to 252; it is used anyway",
                                 where, stride));
      }
    }
    if (size == 0) continue;
    const std::size_t buffer = view["buffer"];
    const std::size_t offset = view.value("byteOffset", std::size_t{0});
    const std::size_t length = list_of(root, "buffers")[buffer]["byteLength"];
    if (offset > length || size > length - offset) {
      throw make_error(
          file, where,
          fmt::format("{} bytes at {}, expected at most {} (buffer {})", size, offset, length, buffer));
    }
  }
}

}  // namespace

ValidatedJson validate(std::string_view text, std::string_view file, const LoadOptions& options,
                       Warnings& warnings) {
  ValidatedJson validated{parse_json(text, file), {}, {}};
  json& root = validated.root;
  check_version(root, file, warnings);
  add_scene(root, warnings);
  validated.animations = list_animations(root);
  check_schema(root, options.scene, choose_animations(root, options, file, warnings), file, warnings);
  check_extensions(root, options.ignore_required, file, warnings);
  complete_cameras(root, file);
  complete_lights(root, warnings);
  complete_links(root);
  check_views(root, file, warnings);
  validated.channels = take_channels(root);
  return validated;
}

}  // namespace gatelight::scene::gltf
