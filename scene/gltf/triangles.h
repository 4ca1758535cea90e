#pragma once
// Converts index buffers and topologies to triangles.

#include <array>
#include <vector>

#include "scene/gltf/document.h"

namespace gatelight::scene::gltf {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// The triangles of a primitive of mode triangles, strip or fan, with or without indices. Throws InputError,
/// also if an index is not below vertex_count.
Triangles read_triangles(const Document& document, const tinygltf::Primitive& primitive,
                         std::size_t vertex_count, const std::string& where, Warnings& warnings);

void check_indices(const Document& document, const Triangles& triangles, std::size_t vertex_count,
                   const std::string& where);

}  // namespace gatelight::scene::gltf
