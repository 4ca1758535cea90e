#include "scene/gltf/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "scene/gltf/deform.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/model.h"
#include "scene/gltf/triangles.h"
#include "scene/gltf/vertices.h"
#include "scene/mesh_arrays.h"

namespace gatelight::scene::gltf {
namespace {

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

/// Reads what the material needs, with tangents of the file.
void read_attributes(const Vertices& vertices, const MeshNeeds& needs, Selection selection, Mesh& mesh) {
  read_rows(vertices, "POSITION", selection, mesh.positions);
  read_rows(vertices, "NORMAL", selection, mesh.normals);
  if (needs.uv[0]) read_rows(vertices, "TEXCOORD_0", selection, mesh.uv0);
  if (needs.uv[1]) read_rows(vertices, "TEXCOORD_1", selection, mesh.uv1);
  // The specification says that tangents of flat-shaded meshes are ignored.
  if (needs.tangents && !mesh.normals.empty()) read_rows(vertices, "TANGENT", selection, mesh.tangents);
  mesh.colors = read_colors(vertices, selection);
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
    warnings.add("points and lines are not rendered");
    return mesh;
  }
  if (!primitive.attributes.contains("POSITION")) {
    warnings.add(fmt::format("{}: no POSITION; it is ignored", where));
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
    warnings.add(fmt::format("{}: no triangles; it is ignored", where));
    return mesh;
  }
  const std::vector<std::uint32_t> selection = compact_vertices(mesh.triangles, vertices.count());

  const Warn warn = [&](std::string_view text) { warnings.add(text); };
  MeshNeeds needs = mesh_needs(material);
  choose_directions(needs, vertices.has("TANGENT") && vertices.has("NORMAL"), vertices.has("TEXCOORD_0"),
                    warn);
  read_attributes(vertices, needs, selection, mesh);
  morph(vertices, primitive, pose.weights, selection, mesh);
  if (!joints.empty()) apply_skin(document, vertices, joints, selection, mesh, warnings);
  if (const ErrorParts wrong = wrong_position(mesh, selection); !wrong.problem.empty())
    document.fail(vertices.where(), sentence(wrong));
  complete_mesh(mesh, needs, warn);
  return mesh;
}

}  // namespace gatelight::scene::gltf
