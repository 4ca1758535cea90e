#include "scene/gltf/document.h"

#include <fmt/format.h>

#include "scene/gltf/extensions.h"
#include "scene/gltf/meshopt.h"
#include "scene/gltf/schema.h"

namespace gatelight::scene::gltf {
namespace {

/// JSON libraries recurse. No valid glTF is nested this deep.
constexpr int kMaxDepth = 100;

/// One byte of a buffer becomes at most 76 bytes of a mesh, unless primitives share accessors: an 8-bit index
/// becomes an index of 4 bytes and at most one vertex of 72. Scenes below kSmallScene bytes may share without
/// limit.
constexpr std::size_t kMostPerByte = 256;
constexpr std::size_t kSmallScene = std::size_t{1} << 30;

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

}  // namespace

Document::Document(const std::filesystem::path& path, bool allow_external, Warnings& warnings)
    : file_(path.string()),
      uris_{path.parent_path(), allow_external},
      container_(open_container(path, warnings)),
      root_(parse_json(container_.json, file_)),
      read_bytes_(container_.file.size) {
  check_schema(root_, file_);
  check_version(root_["asset"], file_);
  check_descriptions();
  check_extensions(root_, file_, warnings);
  load_buffers();
  check_views();
  root_.erase("buffers");  // their data URIs may be as large as the file
  decoded_.resize(list("bufferViews").size());
}

const json& Document::list(const char* name) const {
  static const json kNone = json::array();
  const auto found = root_.find(name);
  return found == root_.end() ? kNone : *found;
}

/// The members that a type demands, which the schema's table cannot express.
void Document::check_descriptions() const {
  const auto require = [&](const json& object, const std::string& member, const std::string& where) {
    if (!object.contains(member)) fail(where, fmt::format("no {}, expected one", member));
  };
  for (std::size_t i = 0; i < list("cameras").size(); ++i) {
    const json& camera = list("cameras")[i];
    require(camera, camera["type"], fmt::format("cameras[{}]", i));
  }
  const json* lights = find_extension(root_, "KHR_lights_punctual");
  for (std::size_t i = 0; lights && i < (*lights)["lights"].size(); ++i) {
    const json& light = (*lights)["lights"][i];
    if (light["type"] != "spot") continue;
    require(light, "spot", fmt::format("extensions.KHR_lights_punctual.lights[{}]", i));
  }
}

void Document::load_buffers() {
  for (const json& source : list("buffers")) {
    const std::size_t i = buffers_.size();
    const std::string where = fmt::format("buffers[{}]", i);
    const std::size_t length = source["byteLength"];
    Buffer buffer;
    if (source.contains("uri")) {
      buffer.storage = read(source["uri"].get_ref<const std::string&>(), where + ".uri");
      read_bytes_ += buffer.storage.size;
      buffer.bytes = buffer.storage.bytes();
    } else if (i == 0 && container_.has_binary) {
      buffer.bytes = container_.binary;
    } else {
      // A placeholder for data that an extension decompresses; range() refuses to read it.
      buffers_.emplace_back();
      continue;
    }
    if (buffer.bytes.size() < length) {
      fail(where, fmt::format("{} bytes, expected {} (byteLength)", buffer.bytes.size(), length));
    }
    buffer.bytes = buffer.bytes.first(length);
    buffers_.push_back(std::move(buffer));
  }
}

void Document::claim(std::size_t bytes, std::string_view where) const {
  const std::size_t most = std::max(kSmallScene, read_bytes_ * kMostPerByte);
  if (bytes <= most && claimed_ <= most - bytes) {
    claimed_ += bytes;
    return;
  }
  fail(where,
       fmt::format(
           "{:.0f} MiB of vertices, triangles and instances up to here, expected at most {} of a file "
           "of {} bytes with its buffers",
           (static_cast<double>(claimed_) + static_cast<double>(bytes)) / 0x1p20, most >> 20, read_bytes_));
}

void Document::check_views() const {
  for (std::size_t i = 0; i < list("bufferViews").size(); ++i) {
    const json& view = list("bufferViews")[i];
    const std::string where = fmt::format("bufferViews[{}]", i);
    const std::size_t stride = view.value("byteStride", std::size_t{0});
    if (stride % 4 != 0) fail(where, fmt::format("byteStride {}, expected a multiple of 4", stride));
    const int buffer = view["buffer"];
    const std::size_t offset = view.value("byteOffset", std::size_t{0});
    const std::size_t size = view["byteLength"];
    const std::size_t length = item("buffers", buffer)["byteLength"];
    if (offset > length || size > length - offset) {
      fail(where,
           fmt::format("{} bytes at {}, expected at most {} (buffer {})", size, offset, length, buffer));
    }
  }
}

Bytes Document::range(const json& place, std::string_view where) const {
  const int buffer = place["buffer"];
  const std::size_t offset = place.value("byteOffset", std::size_t{0});
  const std::size_t length = place["byteLength"];
  const Bytes source = buffers_[static_cast<std::size_t>(buffer)].bytes;
  if (source.empty()) {
    fail(where, fmt::format("buffer {} has no data, expected a uri or a BIN chunk", buffer));
  }
  if (offset > source.size() || length > source.size() - offset) {
    fail(where, fmt::format("{} bytes at {}, expected at most {} (buffer {})", length, offset, source.size(),
                            buffer));
  }
  return source.subspan(offset, length);
}

Bytes Document::view(int index, std::string_view where) const {
  const json& view = item("bufferViews", index);
  const json* meshopt = find_extension(view, "EXT_meshopt_compression");
  if (!meshopt) return range(view, where);

  const std::lock_guard lock(mutex_);
  OwnedBytes& decoded = decoded_[static_cast<std::size_t>(index)];
  if (decoded.size == 0) {
    const std::string place = fmt::format("bufferViews[{}].extensions.EXT_meshopt_compression", index);
    decoded = decode_meshopt(range(*meshopt, place), *meshopt, view["byteLength"], file_, place);
  }
  return decoded.bytes();
}

}  // namespace gatelight::scene::gltf
