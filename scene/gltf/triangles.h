#pragma once
// Converts index buffers and topologies to triangles.

#include <array>
#include <vector>

#include "scene/gltf/document.h"

namespace gatelight::scene::gltf {

/// The modes of a primitive that glTF numbers.
enum Mode { kTriangles = 4, kStrip = 5, kFan = 6 };

inline int mode_of(const json& primitive) {
  return primitive.value("mode", int{kTriangles});
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// The triangles of a primitive of mode triangles, strip or fan, with or without indices. Throws InputError,
/// also if an index is not below vertex_count.
Triangles read_triangles(const Document& document, const json& primitive, std::size_t vertex_count,
                         const std::string& where, Warnings& warnings);

void check_indices(const Document& document, const Triangles& triangles, std::size_t vertex_count,
                   const std::string& where);

}  // namespace gatelight::scene::gltf
