#include "scene/gltf/container.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

namespace gatelight::scene::gltf {
namespace {

constexpr std::uint32_t kMagic = 0x46546c67;   // "glTF"
constexpr std::uint32_t kJson = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinary = 0x004e4942;  // "BIN\0"

std::uint32_t read_u32(Bytes bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[offset + 2]) << 16 |
         static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

void split_glb(Container& container, const std::string& file, Warnings& warnings) {
  Bytes bytes = container.file;
  if (bytes.size() < 12) {
    throw make_error(file, "header", fmt::format("{} bytes, expected a .glb header of 12", bytes.size()));
  }
  const std::uint32_t version = read_u32(bytes, 4);
  if (version != 2) throw make_error(file, "header", fmt::format("version {}, expected 2", version));
  const std::uint32_t length = read_u32(bytes, 8);
  if (length < 20 || length > bytes.size()) {
    warnings.add(
        fmt::format("header: length {}, expected 20 to {} (the size of the file); the whole file is read",
                    length, bytes.size()));
  } else if (length < bytes.size()) {
    warnings.add(
        fmt::format("header: {} bytes after the end of the .glb are ignored", bytes.size() - length));
    bytes = bytes.first(length);
  }

  bool has_json = false;
  std::size_t offset = 12;
  for (int chunk = 0; offset < bytes.size(); ++chunk) {
    const std::string where = fmt::format("chunk {}", chunk);
    if (bytes.size() - offset < 8) {
      warnings.add(fmt::format("{}: {} bytes left, expected a header of 8; they are ignored", where,
                               bytes.size() - offset));
      break;
    }
    std::size_t size = read_u32(bytes, offset);
    const std::uint32_t type = read_u32(bytes, offset + 4);
    offset += 8;
    if (size > bytes.size() - offset && type == kJson) {
      throw make_error(file, where,
                       fmt::format("length {}, expected at most {}", size, bytes.size() - offset));
    }
    if (size > bytes.size() - offset) {
      warnings.add(fmt::format("{}: length {}, expected at most {}, which is used", where, size,
                               bytes.size() - offset));
      size = bytes.size() - offset;
    }
    const Bytes content = bytes.subspan(offset, size);
    if (chunk == 0 && type != kJson) {
      throw make_error(file, where, fmt::format("type {:#010x}, expected JSON first", type));
    }
    if (type == kJson) {
      if (has_json) {
        warnings.add(where + ": a second JSON chunk is ignored");
        offset += size;
        continue;
      }
      has_json = true;
      container.json = {reinterpret_cast<const char*>(content.data()), content.size()};
    } else if (type == kBinary) {
      if (container.has_binary) {
        warnings.add(where + ": a second BIN chunk is ignored");
        offset += size;
        continue;
      }
      container.has_binary = true;
      container.binary = content;
    }
    // Other chunks belong to extensions; the specification requires readers to skip them.
    offset += size;
  }
  if (!has_json) throw make_error(file, "", "no chunk, expected a JSON chunk");
}

/// Scenes of other formats, by their extension.
constexpr std::pair<std::string_view, std::string_view> kOtherFormats[] = {
    {".blend", "a scene of Blender"},
    {".pbrt", "a scene of pbrt"},
    {".xml", "XML, as Mitsuba's scenes are"},
    {".usd", "USD"},
    {".usda", "USD"},
    {".usdc", "USD"},
    {".usdz", "USD"},
    {".obj", "Wavefront OBJ"},
    {".fbx", "FBX"},
    {".dae", "COLLADA"},
    {".abc", "Alembic"},
    {".ply", "PLY"},
    {".stl", "STL"},
    {".3ds", "3D Studio"},
    {".max", "a scene of 3ds Max"},
    {".ma", "a scene of Maya"},
    {".mb", "a scene of Maya"},
    {".c4d", "a scene of Cinema 4D"},
    {".hip", "a scene of Houdini"},
    {".skp", "a model of SketchUp"}};

void refuse_other_formats(const std::filesystem::path& path, Bytes bytes) {
  if (!bytes.empty() && (bytes[0] == '{' || bytes[0] == 'g')) return;  // glTF by another name
  const std::string extension = path.extension().string();
  for (const auto& [name, format] : kOtherFormats) {
    if (extension != name) continue;
    throw make_error(
        path.string(), "",
        fmt::format("{}, expected glTF 2.0 (.gltf, .glb), which Blender and most other tools export",
                    format));
  }
}

}  // namespace

OwnedBytes read_file(const std::filesystem::path& path, std::string_view file, std::string_view where) {
  const auto fail = [&](std::string_view what) {
    const bool itself = path.string() == file;
    throw make_error(file, where, itself ? std::string(what) : fmt::format("'{}' {}", path.string(), what));
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) fail("does not exist, expected a file");
  if (status.type() != std::filesystem::file_type::regular) fail("is not a regular file, expected a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) fail(fmt::format("cannot be read ({}), expected a readable file", error.message()));

  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!stream) fail(fmt::format("cannot be opened ({}), expected a readable file", std::strerror(errno)));
  OwnedBytes bytes(size);
  if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size()) {
    fail(fmt::format("could not be read to its end, expected {} bytes", size));
  }
  return bytes;
}

Container open_container(const std::filesystem::path& path, Warnings& warnings) {
  const std::string file = path.string();
  Container container;
  container.file = read_file(path, file, "");
  const Bytes bytes = container.file;
  refuse_other_formats(path, bytes);
  if (bytes.empty()) throw make_error(file, "", "an empty file, expected glTF 2.0");
  if (bytes.size() >= 4 && read_u32(bytes, 0) == kMagic) {
    split_glb(container, file, warnings);
  } else if (path.extension() == ".glb") {
    throw make_error(file, "header", "no 'glTF' at the beginning, expected a .glb file");
  } else {
    container.json = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  return container;
}

}  // namespace gatelight::scene::gltf
