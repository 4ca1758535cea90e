#pragma once
// Generates tangent frames for normal maps when the file has none.

#include "scene/scene.h"

namespace gatelight::scene {

/// Fills mesh.tangents so that x and y of the texture behind `slot` point along the surface's u and -v. A
/// vertex shared by mirrored and unmirrored triangles is split. In a mesh without normals each triangle has
/// its own frame, so all vertices are split.
void generate_tangents(Mesh& mesh, const TextureSlot& slot);

}  // namespace gatelight::scene
