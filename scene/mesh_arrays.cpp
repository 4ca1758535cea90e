#include "scene/mesh_arrays.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/material_fields.h"
#include "scene/tangents.h"
#include "scene/vertex_repair.h"

namespace gatelight::scene {

MeshNeeds mesh_needs(const Material& material) {
  MeshNeeds needs;
  for_each_slot(material, [&](const TextureSlot& slot, bool) {
    if (slot) needs.uv[static_cast<std::size_t>(slot.texcoord)] = true;
  });
  if (material.anisotropy > 0.0f) needs.tangents = &material.anisotropy_texture;
  if (material.clearcoat_normal_texture) needs.tangents = &material.clearcoat_normal_texture;
  if (material.normal_texture) needs.tangents = &material.normal_texture;
  return needs;
}

ErrorParts wrong_index(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t vertices) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t index : triangles[i]) {
      if (index < vertices) continue;
      return {.problem = fmt::format("index {} in triangle {}", index, i),
              .expected = fmt::format("less than {} (the vertices)", vertices)};
    }
  }
  return {};
}

ErrorParts wrong_position(const Mesh& mesh, const std::vector<std::uint32_t>& numbers) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (mesh.positions[i].allFinite()) continue;
    const Vec3& p = mesh.positions[i];
    return {.problem = fmt::format("position {} is ({}, {}, {})", numbers.empty() ? i : numbers[i], p.x(),
                                   p.y(), p.z()),
            .expected = "finite numbers"};
  }
  return {};
}

std::vector<std::uint32_t> compact_vertices(std::vector<std::array<std::uint32_t, 3>>& triangles,
                                            std::size_t vertices) {
  std::vector<std::uint32_t> used;
  if (triangles.size() * 3 < vertices) {
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
  std::vector<std::uint32_t> place(vertices, 0);
  for (const auto& t : triangles) {
    for (const std::uint32_t i : t) place[i] = 1;
  }
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < vertices; ++i) {
    if (place[i] == 0) continue;
    place[i] = next++;
    used.push_back(i);
  }
  if (next == vertices) return {};
  for (auto& t : triangles) {
    for (std::uint32_t& i : t) i = place[i];
  }
  return used;
}

void choose_directions(MeshNeeds& needs, bool tangents, bool uv, const Warn& warn) {
  if (!needs.tangents || *needs.tangents) return;
  needs.uv[0] |= !tangents && uv;
  if (tangents || needs.uv[0]) return;
  warn("an anisotropic mesh has neither tangents nor texture coordinates: its reflection becomes isotropic");
  needs.tangents = nullptr;
}

void complete_mesh(Mesh& mesh, const MeshNeeds& needs, const Warn& warn) {
  if (repair_normals(mesh)) warn("normals that are zero or not finite are replaced by the triangles' own");
  if (repair_uvs(mesh)) warn("texture coordinates that are not finite are replaced by zero");
  if ((needs.uv[0] && mesh.uv0.empty()) || (needs.uv[1] && mesh.uv1.empty()))
    warn("a textured mesh has no texture coordinates");
  if (!needs.tangents) return;
  if (mesh.tangents.empty()) {
    generate_tangents(mesh, *needs.tangents);
  } else {
    repair_tangents(mesh);
  }
}

}  // namespace gatelight::scene
