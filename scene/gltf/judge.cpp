#include "scene/gltf/judge.h"

#include <fmt/format.h>

#include <string>

#include "scene/gltf/extensions.h"
#include "scene/gltf/schema.h"

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

/// Accepts "2." and digits: the specification keeps minor versions compatible.
bool is_version_2(std::string_view version) {
  return version.size() > 2 && version.starts_with("2.") &&
         version.find_first_not_of("0123456789", 2) == std::string_view::npos;
}

void check_version(const json& asset, std::string_view file) {
  for (const char* key : {"version", "minVersion"}) {
    if (!asset.contains(key)) continue;
    const std::string& version = asset[key].get_ref<const std::string&>();
    const bool fits = std::string_view(key) == "version" ? is_version_2(version) : version == "2.0";
    if (!fits)
      throw make_error(file, fmt::format("asset.{}", key), fmt::format("'{}', expected 2.0", version));
  }
}

/// A list of the root; empty if the file has none.
const json& list(const json& root, const char* name) {
  static const json kNone = json::array();
  const auto found = root.find(name);
  return found == root.end() ? kNone : *found;
}

/// The members that a type demands, which the schema's table cannot express.
void check_descriptions(const json& root, std::string_view file) {
  const auto require = [&](const json& object, const std::string& member, const std::string& where) {
    if (!object.contains(member)) throw make_error(file, where, fmt::format("no {}, expected one", member));
  };
  const json& cameras = list(root, "cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    require(cameras[i], cameras[i]["type"], fmt::format("cameras[{}]", i));
  }
  const json::json_pointer place("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(place)) return;
  const json& lights = root.at(place);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i]["type"] != "spot") continue;
    require(lights[i], "spot", fmt::format("extensions.KHR_lights_punctual.lights[{}]", i));
  }
}

void check_views(const json& root, std::string_view file) {
  const json& views = list(root, "bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const json& view = views[i];
    const std::string where = fmt::format("bufferViews[{}]", i);
    const std::size_t stride = view.value("byteStride", std::size_t{0});
    if (stride % 4 != 0)
      throw make_error(file, where, fmt::format("byteStride {}, expected a multiple of 4", stride));
    const std::size_t buffer = view["buffer"];
    const std::size_t offset = view.value("byteOffset", std::size_t{0});
    const std::size_t size = view["byteLength"];
    const std::size_t length = list(root, "buffers")[buffer]["byteLength"];
    if (offset > length || size > length - offset) {
      throw make_error(
          file, where,
          fmt::format("{} bytes at {}, expected at most {} (buffer {})", size, offset, length, buffer));
    }
  }
}

}  // namespace

json judge(std::string_view text, std::string_view file, Warnings& warnings) {
  json root = parse_json(text, file);
  check_schema(root, file);
  check_version(root["asset"], file);
  check_descriptions(root, file);
  check_extensions(root, file, warnings);
  check_views(root, file);
  return root;
}

}  // namespace gatelight::scene::gltf
