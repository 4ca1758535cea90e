#pragma once
// Tangent frames for normal maps where the file has none.

#include "scene/scene.h"

namespace gatelight::scene {

/// Fills mesh.tangents so that x and y of the texture behind `slot` point along the surface's u and -v.
/// A vertex that mirrored and unmirrored triangles share is split; a mesh without normals loses its sharing
/// of vertices, since each of its triangles has a frame of its own.
void generate_tangents(Mesh& mesh, const TextureSlot& slot);

}  // namespace gatelight::scene
