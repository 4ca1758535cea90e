#include "apps/manual/cameras.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

namespace gatelight::apps {
namespace {

using nlohmann::json;

/// The Tab key must not wait for larger files.
constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;

/// The JSON of a .gltf or .glb; empty where there is none.
std::string json_of(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return "";
  std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  // Header of a .glb and of its first chunk: magic, version, length; length, type.
  std::array<std::uint32_t, 5> header{};
  if (size >= sizeof(header)) file.read(reinterpret_cast<char*>(header.data()), sizeof(header));
  if (std::memcmp(header.data(), "glTF", 4) == 0) {
    size = std::min<std::uint64_t>(header[3], size - sizeof(header));
  } else {
    file.seekg(0);
  }
  if (error || size > kMaxBytes) return "";
  std::string text(size, '\0');
  file.read(text.data(), static_cast<std::streamsize>(size));
  return file ? text : "";
}

std::string name_of(const json& object) {
  const auto name = object.find("name");
  return name != object.end() && name->is_string() ? name->get<std::string>() : "";
}

/// A name from a file must not control the terminal, nor end a line.
bool is_plain(const std::string& name) {
  return std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

}  // namespace

std::vector<std::string> camera_names(const std::filesystem::path& scene) {
  const json root = json::parse(json_of(scene), nullptr, false);
  if (!root.is_object() || !root.contains("nodes") || !root.contains("cameras")) return {};
  const json& cameras = root["cameras"];
  std::vector<std::string> names;
  for (const json& node : root["nodes"]) {
    if (!node.is_object() || !node.contains("camera") || !node["camera"].is_number_unsigned()) continue;
    const auto index = node["camera"].get<std::size_t>();
    if (!cameras.is_array() || index >= cameras.size() || !cameras[index].is_object()) continue;
    std::string name = name_of(cameras[index]);
    if (name.empty()) name = name_of(node);
    if (!name.empty() && is_plain(name) && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(std::move(name));
  }
  return names;
}

}  // namespace gatelight::apps
