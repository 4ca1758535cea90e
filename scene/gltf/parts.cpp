#include "scene/gltf/parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/nearest_word.h"
#include "scene/bake.h"
#include "scene/gltf/model.h"
#include "scene/gltf/numbering.h"

namespace gatelight::scene::gltf {
namespace {

/// Size of a position, normal, tangent, two texture coordinates and a colour.
constexpr std::size_t kVertexBytes = (3 + 3 + 4 + 2 + 2 + 4) * sizeof(float);

int material_of(const tinygltf::Primitive& primitive, int variant) {
  const tinygltf::Value* extension = find_extension(primitive.extensions, "KHR_materials_variants");
  if (variant >= 0 && extension) {
    for (const tinygltf::Value& mapping : array_of(*extension, "mappings")) {
      for (const tinygltf::Value& mapped : array_of(mapping, "variants")) {
        if (mapped.GetNumberAsInt() == variant) return integer_or(mapping, "material", -1);
      }
    }
  }
  return primitive.material;
}

/// Memory of a primitive according to its accessors; 0 for Draco, whose size is only in the compressed data.
std::size_t mesh_bytes(const Document& document, const MeshPart& part) {
  const tinygltf::Primitive& primitive =
      element(element(document.model().meshes, part.mesh).primitives, part.primitive);
  const auto positions = primitive.attributes.find("POSITION");
  if (positions == primitive.attributes.end() || primitive.mode < TINYGLTF_MODE_TRIANGLES) return 0;
  if (find_extension(primitive.extensions, "KHR_draco_mesh_compression")) return 0;
  const auto count_of = [&](int accessor) { return element(document.model().accessors, accessor).count; };
  const std::size_t vertices = count_of(positions->second);
  const std::size_t indices = primitive.indices >= 0 ? count_of(primitive.indices) : vertices;
  const std::size_t triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? indices / 3 : indices;
  return triangles * sizeof(std::array<std::uint32_t, 3>) + std::min(vertices, 3 * triangles) * kVertexBytes;
}

}  // namespace

Parts::Parts(const Document& document, const Graph& graph, int variant) : first_(graph.poses.size(), -1) {
  Numbering materials;
  for (const Placement& placement : graph.placements) {
    int& first = first_[static_cast<std::size_t>(placement.pose)];
    if (first >= 0) continue;
    first = static_cast<int>(parts_.size());
    const int mesh = element(graph.poses, placement.pose).mesh;
    const auto& primitives = element(document.model().meshes, mesh).primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      parts_.push_back({placement.pose, mesh, static_cast<int>(i),
                        materials.number_of(material_of(primitives[i], variant))});
    }
  }
  materials_ = materials.order();
}

void Parts::claim(const Document& document, const Graph& graph, bool baked) const {
  for (const MeshPart& part : parts_) {
    document.claim(mesh_bytes(document, part),
                   fmt::format("meshes[{}].primitives[{}]", part.mesh, part.primitive));
  }
  for (const Placement& placement : graph.placements) {
    const bool copied = baked && !placement.moves && is_flat(rounded(placement.transform));
    std::size_t bytes = 0;
    for_each_of(placement.pose, [&](std::size_t i) {
      bytes += sizeof(Instance) + placement.name.size() + (copied ? mesh_bytes(document, parts_[i]) : 0);
    });
    document.claim(bytes, fmt::format("meshes[{}]", element(graph.poses, placement.pose).mesh));
  }
}

std::vector<std::string> variant_names(const Document& document) {
  std::vector<std::string> names;
  if (const tinygltf::Value* extension =
          find_extension(document.model().extensions, "KHR_materials_variants")) {
    for (const tinygltf::Value& variant : array_of(*extension, "variants"))
      names.push_back(text_or(variant, "name", ""));
  }
  return names;
}

int find_variant(const Document& document, const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  document.fail("KHR_materials_variants",
                fmt::format("there is no variant '{}', expected {}{}", name,
                            names.empty() ? "none: the file has no variants"
                                          : fmt::format("one of: {}", fmt::join(names, ", ")),
                            did_you_mean(name, names)));
}

}  // namespace gatelight::scene::gltf
