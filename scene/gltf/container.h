#pragma once
// Reads a file's bytes and splits a .glb into its JSON and binary parts.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

using Bytes = std::span<const std::uint8_t>;

/// Bytes with one owner, not initialised.
struct OwnedBytes {
  std::unique_ptr<std::uint8_t[]> data;
  std::size_t size = 0;

  explicit OwnedBytes(std::size_t n = 0) : data(std::make_unique_for_overwrite<std::uint8_t[]>(n)), size(n) {}
  Bytes bytes() const { return {data.get(), size}; }
};

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
