#pragma once
// Reads a file's bytes and splits a .glb into its JSON and binary parts.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

using Bytes = std::span<const std::uint8_t>;

using OwnedBytes = std::vector<std::uint8_t>;

/// Reads a whole file. An InputError names `file` (the scene) and `where` (the place in the scene that refers
/// to `path`).
OwnedBytes read_file(const std::filesystem::path& path, std::string_view file, std::string_view where);

struct Container {
  OwnedBytes file;
  std::string_view json;  ///< points into file
  Bytes binary;           ///< the .glb's BIN chunk; points into file
  bool has_binary = false;
};

/// Opens a .glb or .gltf; the first bytes decide which it is, not the name. Throws InputError.
Container open_container(const std::filesystem::path& path, Warnings& warnings);

}  // namespace gatelight::scene::gltf
