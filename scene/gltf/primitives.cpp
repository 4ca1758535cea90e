#include "scene/gltf/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scene/gltf/deform.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/model.h"
#include "scene/gltf/triangles.h"
#include "scene/gltf/vertices.h"
#include "scene/tangents.h"
#include "scene/texture_slots.h"
#include "scene/vertex_repair.h"

namespace gatelight::scene::gltf {
namespace {

struct Needs {
  bool uv[2] = {false, false};
  const TextureSlot* tangents = nullptr;  ///< the slot whose frame is needed
};

Needs needs_of(const Material& material) {
  Needs needs;
  for_each_slot(material, [&](const TextureSlot& slot, bool) {
    if (slot) needs.uv[slot.texcoord] = true;
  });
  if (material.anisotropy > 0.0f) needs.tangents = &material.anisotropy_texture;
  if (material.clearcoat_normal_texture) needs.tangents = &material.clearcoat_normal_texture;
  if (material.normal_texture) needs.tangents = &material.normal_texture;
  return needs;
}

std::vector<Vec4> read_colors(const Vertices& vertices, Selection selection) {
  std::vector<Vec4> rows;
  if (!vertices.has("COLOR_0")) return rows;
  rows.resize(selection.empty() ? vertices.count() : selection.size(), Vec4::Ones());
  vertices.read("COLOR_0", {3, 4}, selection, 4, rows.data()->data(), true);
  for (Vec4& row : rows) {
    for (int c = 0; c < 4; ++c) row[c] = row[c] >= 0.0f ? std::min(row[c], 1.0f) : 0.0f;
  }
  if (std::all_of(rows.begin(), rows.end(), [](const Vec4& row) { return (row.array() == 1.0f).all(); }))
    rows = {};
  return rows;
}

/// Returns the vertices that triangles use, in order, and renumbers the triangles; empty if all are used.
std::vector<std::uint32_t> compact(std::vector<std::array<std::uint32_t, 3>>& triangles,
                                   std::size_t vertex_count) {
  std::vector<std::uint32_t> used;
  if (triangles.size() * 3 < vertex_count) {
    // Many primitives may share one large accessor, so the cost must stay proportional to this primitive.
    used.reserve(triangles.size() * 3);
    for (const auto& t : triangles) used.insert(used.end(), t.begin(), t.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (auto& t : triangles) {
      for (std::uint32_t& i : t) {
        i = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), i) - used.begin());
      }
    }
    return used;
  }
  std::vector<std::uint32_t> place(vertex_count, 0);
  for (const auto& t : triangles) {
    for (const std::uint32_t i : t) place[i] = 1;
  }
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < vertex_count; ++i) {
    if (place[i] == 0) continue;
    place[i] = next++;
    used.push_back(i);
  }
  if (next == vertex_count) return {};
  for (auto& t : triangles) {
    for (std::uint32_t& i : t) i = place[i];
  }
  return used;
}

/// Reads what the material needs, with tangents of the file.
void read_attributes(const Vertices& vertices, const Needs& needs, Selection selection, Mesh& mesh) {
  read_rows(vertices, "POSITION", selection, mesh.positions);
  read_rows(vertices, "NORMAL", selection, mesh.normals);
  if (needs.uv[0]) read_rows(vertices, "TEXCOORD_0", selection, mesh.uv0);
  if (needs.uv[1]) read_rows(vertices, "TEXCOORD_1", selection, mesh.uv1);
  // The specification says that tangents of flat-shaded meshes are ignored.
  if (needs.tangents && !mesh.normals.empty()) read_rows(vertices, "TANGENT", selection, mesh.tangents);
  mesh.colors = read_colors(vertices, selection);
}

/// Checks the positions, repairs the other attributes, and generates missing tangents.
void complete(const Document& document, const Vertices& vertices, const Needs& needs, Selection selection,
              Mesh& mesh, Warnings& warnings) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (mesh.positions[i].allFinite()) continue;
    const Vec3& p = mesh.positions[i];
    document.fail(vertices.where(), fmt::format("position {} is ({}, {}, {}), expected finite numbers",
                                                selection.empty() ? i : selection[i], p.x(), p.y(), p.z()));
  }
  if (repair_normals(mesh))
    warnings.add("normals that are zero or not finite are replaced by the triangles' own");
  if (repair_uvs(mesh)) warnings.add("texture coordinates that are not finite are replaced by zero");
  if ((needs.uv[0] && mesh.uv0.empty()) || (needs.uv[1] && mesh.uv1.empty())) {
    warnings.add("a textured mesh has no texture coordinates");
  }
  if (!needs.tangents) return;
  if (mesh.tangents.empty()) {
    generate_tangents(mesh, *needs.tangents);
  } else {
    repair_tangents(mesh);
  }
}

}  // namespace

Mesh load_primitive(const Document& document, const Pose& pose, int primitive_index,
                    std::span<const JointMatrix> joints, const Material& material, Warnings& warnings) {
  const tinygltf::Mesh& source = element(document.model().meshes, pose.mesh);
  const tinygltf::Primitive& primitive = element(source.primitives, primitive_index);
  const std::string where = fmt::format("meshes[{}].primitives[{}]", pose.mesh, primitive_index);

  Mesh mesh;
  mesh.name = source.name;
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    warnings.add("points and lines are not drawn");
    return mesh;
  }
  if (!primitive.attributes.contains("POSITION")) {
    warnings.add(fmt::format("{}: no POSITION, it is left out", where));
    return mesh;
  }
  const tinygltf::Value* extension = find_extension(primitive.extensions, "KHR_draco_mesh_compression");
  std::optional<DracoPrimitive> draco;
  if (extension) draco.emplace(document, *extension, where);

  const Vertices vertices(document, primitive, draco ? &*draco : nullptr, where, warnings);
  if (draco) {
    draco->read_triangles(mesh.triangles);
    check_indices(document, mesh.triangles, vertices.count(), where);
  } else if (vertices.count() > 0) {
    mesh.triangles = read_triangles(document, primitive, vertices.count(), where, warnings);
  }
  if (mesh.triangles.empty()) {
    warnings.add(fmt::format("{}: no triangles, it is left out", where));
    return mesh;
  }
  const std::vector<std::uint32_t> selection = compact(mesh.triangles, vertices.count());

  Needs needs = needs_of(material);
  // An anisotropic material without textures takes its directions from the file's tangents, else from the
  // texture coordinates.
  const bool own_tangents = vertices.has("TANGENT") && vertices.has("NORMAL");
  if (needs.tangents && !*needs.tangents) {
    needs.uv[0] |= !own_tangents && vertices.has("TEXCOORD_0");
    if (!own_tangents && !needs.uv[0]) {
      warnings.add(
          "an anisotropic mesh has neither tangents nor texture coordinates: it reflects alike in all "
          "directions");
      needs.tangents = nullptr;
    }
  }
  read_attributes(vertices, needs, selection, mesh);
  morph(vertices, primitive, pose.weights, selection, mesh);
  if (!joints.empty()) apply_skin(document, vertices, joints, selection, mesh, warnings);
  complete(document, vertices, needs, selection, mesh, warnings);
  return mesh;
}

}  // namespace gatelight::scene::gltf
