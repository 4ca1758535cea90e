#include "scene/gltf/document.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scene/gltf/extensions.h"
#include "scene/gltf/meshopt.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/uri.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

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
  // The specification asks for spaces as padding, but some exporters write zero bytes.
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

std::vector<ImageSource> read_images(const json& root) {
  std::vector<ImageSource> images;
  const auto list = root.find("images");
  if (list == root.end()) return images;
  for (const json& image : *list) {
    ImageSource source;
    source.uri = image.value("uri", "");
    source.buffer_view = image.value("bufferView", -1);
    source.name = image.value("name", source.uri.empty() ? "" : uri_name(source.uri));
    if (source.name.empty()) source.name = fmt::format("images[{}]", images.size());
    images.push_back(std::move(source));
  }
  return images;
}

/// Removes what tinygltf need not see or cannot handle.
void strip(json& root) {
  for (const char* key : {"buffers", "images", "animations", "extras"}) root.erase(key);
  if (!root.contains("accessors")) return;
  json& views = root["bufferViews"];
  const std::size_t none = views.size();
  bool used = false;
  for (json& accessor : root["accessors"]) {
    accessor.erase("min");
    accessor.erase("max");
    if (accessor.contains("bufferView")) continue;
    accessor["bufferView"] = none;
    used = true;
  }
  if (used) views.push_back({{"buffer", 0}, {"byteLength", 1}});
}

}  // namespace

struct Document::Json {
  json root;
};

Document::Document(const std::filesystem::path& path, bool allow_external, Warnings& warnings)
    : file_(path.string()),
      uris_{path.parent_path(), allow_external},
      container_(open_container(path, warnings)),
      read_bytes_(container_.file.size) {
  Json document{parse_json(container_.json, file_)};
  json& root = document.root;
  check_schema(root, file_);
  check_version(root["asset"], file_);
  images_ = read_images(root);
  view_count_ = root.contains("bufferViews") ? root["bufferViews"].size() : 0;

  const json buffers = root.value("buffers", json::array());
  strip(root);
  const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  tinygltf::TinyGLTF parser;
  std::string error;
  std::string ignored;
  bool parsed = false;
  try {
    parsed = parser.LoadASCIIFromString(&model_, &error, &ignored, text.c_str(),
                                        static_cast<unsigned>(text.size()), "", tinygltf::NO_REQUIRE);
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!parsed) fail("JSON", fmt::format("{}, expected glTF 2.0", one_line(error)));

  check_extensions(model_, file_, warnings);
  root = json{{"buffers", buffers}};
  load_buffers(document);
  check_views();
  decoded_.resize(view_count_);
}

void Document::load_buffers(const Json& document) {
  const json& list = document.root["buffers"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string where = fmt::format("buffers[{}]", i);
    Buffer buffer;
    buffer.length = list[i]["byteLength"].get<std::size_t>();
    const bool has_uri = list[i].contains("uri");
    if (has_uri) {
      buffer.storage = read(list[i]["uri"].get_ref<const std::string&>(), where + ".uri");
      read_bytes_ += buffer.storage.size;
      buffer.bytes = buffer.storage.bytes();
      buffer.present = true;
    } else if (i == 0 && container_.has_binary) {
      buffer.bytes = container_.binary;
      buffer.present = true;
    }
    // A buffer without a source is a placeholder for data that an extension decompresses; range() refuses to
    // read it.
    if (buffer.present) {
      if (buffer.bytes.size() < buffer.length) {
        fail(where, fmt::format("{} bytes, expected {} (byteLength)", buffer.bytes.size(), buffer.length));
      }
      buffer.bytes = buffer.bytes.first(buffer.length);
    }
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
  for (std::size_t i = 0; i < view_count_; ++i) {
    const tinygltf::BufferView& view = model_.bufferViews[i];
    const std::size_t length = buffers_[static_cast<std::size_t>(view.buffer)].length;
    if (view.byteOffset > length || view.byteLength > length - view.byteOffset) {
      fail(fmt::format("bufferViews[{}]", i),
           fmt::format("{} bytes at {}, expected at most {} (buffer {})", view.byteLength, view.byteOffset,
                       length, view.buffer));
    }
  }
}

Bytes Document::range(int buffer, std::size_t offset, std::size_t length, std::string_view where) const {
  const Buffer& source = buffers_[static_cast<std::size_t>(buffer)];
  if (!source.present)
    fail(where, fmt::format("buffer {} has no data, expected a uri or a BIN chunk", buffer));
  if (offset > source.bytes.size() || length > source.bytes.size() - offset) {
    fail(where, fmt::format("{} bytes at {}, expected at most {} (buffer {})", length, offset,
                            source.bytes.size(), buffer));
  }
  return source.bytes.subspan(offset, length);
}

Bytes Document::view(int index, std::string_view where) const {
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
  const tinygltf::Value* meshopt = find_extension(view.extensions, "EXT_meshopt_compression");
  if (!meshopt) return range(view.buffer, view.byteOffset, view.byteLength, where);

  const std::lock_guard lock(mutex_);
  OwnedBytes& decoded = decoded_[static_cast<std::size_t>(index)];
  if (decoded.size == 0) {
    const std::string place = fmt::format("bufferViews[{}].extensions.EXT_meshopt_compression", index);
    const auto member = [&](const char* name) {
      return static_cast<std::size_t>(number_or(*meshopt, name, 0.0));
    };
    const Bytes source =
        range(integer_or(*meshopt, "buffer", 0), member("byteOffset"), member("byteLength"), place);
    decoded = decode_meshopt(source, *meshopt, view.byteLength, file_, place);
  }
  return decoded.bytes();
}

}  // namespace gatelight::scene::gltf
