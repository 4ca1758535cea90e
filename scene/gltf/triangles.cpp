#include "scene/gltf/triangles.h"

#include <fmt/format.h>

#include <numeric>
#include <optional>

#include "scene/gltf/accessors.h"
#include "scene/mesh_arrays.h"

namespace gatelight::scene::gltf {
namespace {

/// Triangles of a strip or a fan. The winding follows the specification, section 3.7.2.1.
Triangles assemble(const std::vector<std::uint32_t>& v, bool strip) {
  Triangles triangles;
  if (v.size() < 3) return triangles;
  triangles.reserve(v.size() - 2);
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (strip) {
      triangles.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    } else {
      triangles.push_back({v[i + 1], v[i + 2], v[0]});
    }
  }
  return triangles;
}

}  // namespace

void check_indices(const Document& document, const Triangles& triangles, std::size_t vertex_count,
                   const std::string& where) {
  const ErrorParts wrong = wrong_index(triangles, vertex_count);
  if (!wrong.problem.empty()) document.fail(where, sentence(wrong));
}

Triangles read_triangles(const Document& document, const tinygltf::Primitive& primitive,
                         std::size_t vertex_count, const std::string& where, Warnings& warnings) {
  std::optional<AccessorReader> indices;
  if (primitive.indices >= 0) indices.emplace(document, primitive.indices);
  const std::size_t count = indices ? indices->count() : vertex_count;
  const auto fill = [&](std::uint32_t* out) {
    if (indices) {
      indices->read_indices(out);
    } else {
      std::iota(out, out + count, 0u);
    }
  };

  const bool strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
  Triangles triangles;
  if (strip || primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN) {
    std::vector<std::uint32_t> list(count);
    fill(list.data());
    triangles = assemble(list, strip);
  } else if (count % 3 == 0) {
    triangles.resize(count / 3);
    if (count > 0) fill(triangles.data()->data());
  } else {
    warnings.add(fmt::format("{}: {} indices are not a multiple of 3; the rest is ignored", where, count));
    std::vector<std::uint32_t> list(count);
    fill(list.data());
    triangles.reserve(count / 3);
    for (std::size_t i = 0; i + 2 < count; i += 3) triangles.push_back({list[i], list[i + 1], list[i + 2]});
  }
  check_indices(document, triangles, vertex_count, where);
  return triangles;
}

}  // namespace gatelight::scene::gltf
