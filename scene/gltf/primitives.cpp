#include "scene/gltf/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "scene/gltf/accessors.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/model.h"
#include "scene/gltf/triangles.h"
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

/// The source of a primitive's vertices: accessors, or Draco's data described by accessors.
class Vertices {
 public:
  Vertices(const Document& document, const tinygltf::Primitive& primitive, const DracoPrimitive* draco,
           std::string where)
      : document_(document), attributes_(primitive.attributes), draco_(draco), where_(std::move(where)) {
    if (!has("POSITION")) document.fail(where_ + ".attributes", "no POSITION, expected one");
    count_ = draco ? draco->vertex_count() : reader("POSITION").count();
    if (count_ > 0xffffffffu)
      document.fail(where_, fmt::format("{} vertices, expected at most 2^32 - 1", count_));
  }

  std::size_t count() const { return count_; }

  bool has(const std::string& semantic) const {
    return attributes_.contains(semantic) || (draco_ && draco_->has(semantic));
  }

  /// Writes one row for each element of the selection, or count() rows if it is empty.
  void read(const std::string& semantic, std::initializer_list<int> components, Selection selection,
            int width, float* out, bool force_normalized = false) const {
    if (draco_ && draco_->has(semantic)) {
      bool normalized = force_normalized;
      if (attributes_.contains(semantic)) {
        normalized |= element(document_.model().accessors, attributes_.at(semantic)).normalized;
      }
      draco_->read_floats(semantic, selection, width, normalized, out);
      return;
    }
    const AccessorReader source = reader(semantic);
    source.expect_attribute(semantic, components);
    if (source.count() != count_) {
      document_.fail(source.where(), fmt::format("count {} for {} of {}, expected {} as POSITION",
                                                 source.count(), semantic, where_, count_));
    }
    source.read_floats(selection, width, out, force_normalized);
  }

 private:
  AccessorReader reader(const std::string& semantic) const {
    return AccessorReader(document_, attributes_.at(semantic));
  }

  const Document& document_;
  const std::map<std::string, int>& attributes_;
  const DracoPrimitive* draco_;
  std::string where_;
  std::size_t count_ = 0;
};

/// Leaves the rows empty where the file has none.
template <typename Rows>
void read_rows(const Vertices& vertices, const std::string& semantic, Selection selection, Rows& rows) {
  constexpr int kWidth = Rows::value_type::RowsAtCompileTime;
  if (!vertices.has(semantic)) return;
  rows.resize(selection.empty() ? vertices.count() : selection.size());
  vertices.read(semantic, {kWidth}, selection, kWidth, rows.data()->data());
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

}  // namespace

Mesh load_primitive(const Document& document, int mesh_index, int primitive_index, const Material& material,
                    Warnings& warnings) {
  const tinygltf::Mesh& source = element(document.model().meshes, mesh_index);
  const tinygltf::Primitive& primitive = element(source.primitives, primitive_index);
  const std::string where = fmt::format("meshes[{}].primitives[{}]", mesh_index, primitive_index);

  Mesh mesh;
  mesh.name = source.name;
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    warnings.add("points and lines are not drawn");
    return mesh;
  }
  const tinygltf::Value* extension = find_extension(primitive.extensions, "KHR_draco_mesh_compression");
  std::optional<DracoPrimitive> draco;
  if (extension) draco.emplace(document, *extension, where);

  const Vertices vertices(document, primitive, draco ? &*draco : nullptr, where);
  if (draco) {
    draco->read_triangles(mesh.triangles);
    check_indices(document, mesh.triangles, vertices.count(), where);
  } else {
    mesh.triangles = read_triangles(document, primitive, vertices.count(), where, warnings);
  }
  if (mesh.triangles.empty()) return mesh;
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
  read_rows(vertices, "POSITION", selection, mesh.positions);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (mesh.positions[i].allFinite()) continue;
    const Vec3& p = mesh.positions[i];
    document.fail(where, fmt::format("position {} is ({}, {}, {}), expected finite numbers",
                                     selection.empty() ? i : selection[i], p.x(), p.y(), p.z()));
  }
  read_rows(vertices, "NORMAL", selection, mesh.normals);
  if (needs.uv[0]) read_rows(vertices, "TEXCOORD_0", selection, mesh.uv0);
  if (needs.uv[1]) read_rows(vertices, "TEXCOORD_1", selection, mesh.uv1);
  mesh.colors = read_colors(vertices, selection);

  if (repair_normals(mesh))
    warnings.add("normals that are zero or not finite are replaced by the triangles' own");
  if (repair_uvs(mesh)) warnings.add("texture coordinates that are not finite are replaced by zero");
  if ((needs.uv[0] && mesh.uv0.empty()) || (needs.uv[1] && mesh.uv1.empty())) {
    warnings.add("a textured mesh has no texture coordinates");
  }
  if (needs.tangents) {
    // The specification says that tangents of flat-shaded meshes are ignored.
    if (!mesh.normals.empty()) read_rows(vertices, "TANGENT", selection, mesh.tangents);
    if (mesh.tangents.empty()) {
      generate_tangents(mesh, *needs.tangents);
    } else {
      repair_tangents(mesh);
    }
  }
  return mesh;
}

}  // namespace gatelight::scene::gltf
