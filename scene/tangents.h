#pragma once
// Generates tangent frames for normal maps when the file has none.

#include "scene/scene.h"

namespace gatelight::scene {

/// Fills mesh.tangents so that x and y of the texture behind `slot` point along the surface's u and -v, by
/// the rules of MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", and his description
/// of the tangent space). A vertex whose corners get different tangents is split. In a mesh without normals
/// all vertices are split.
void generate_tangents(Mesh& mesh, const TextureSlot& slot);

}  // namespace gatelight::scene
