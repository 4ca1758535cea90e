#pragma once
// Arrays of a mesh become a mesh that can be rendered: checks, repairs and tangents.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "scene/scene.h"

namespace gatelight::scene {

/// The attributes that a material reads.
struct MeshNeeds {
  std::array<bool, 2> uv{};
  const TextureSlot* tangents = nullptr;  ///< the slot whose frame is needed; a member of the material
};

MeshNeeds mesh_needs(const Material& material);

/// The first index that is not below `vertices`; without a problem where there is none.
ErrorParts wrong_index(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t vertices);

/// The first position that is not finite; without a problem where there is none. `numbers` are those of the
/// positions in messages; empty: their places.
ErrorParts wrong_position(const Mesh& mesh, const std::vector<std::uint32_t>& numbers = {});

/// Renumbers the triangles for the vertices that they use. Returns these vertices in order; empty if all are
/// used.
std::vector<std::uint32_t> compact_vertices(std::vector<std::array<std::uint32_t, 3>>& triangles,
                                            std::size_t vertices);

using Warn = std::function<void(std::string_view)>;

/// Without tangents and texture coordinates a mesh has no directions for an anisotropic material without
/// textures: then it reflects alike in all directions. `tangents`: the mesh has tangents and normals of its
/// own; `uv`: it has texture coordinates. Call it before the attributes are read.
void choose_directions(MeshNeeds& needs, bool tangents, bool uv, const Warn& warn);

/// Repairs normals and texture coordinates, and generates missing tangents. Positions must be finite, and
/// indices in range.
void complete_mesh(Mesh& mesh, const MeshNeeds& needs, const Warn& warn);

}  // namespace gatelight::scene
