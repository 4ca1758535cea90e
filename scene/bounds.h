#pragma once
// Extent of a scene in the world.

#include "scene/scene.h"

namespace gatelight::scene {

/// Box around all triangles' vertices; empty when there are none. Exact, unless very many instances share
/// large meshes: then the transformed box of the mesh stands for its vertices.
Box compute_bounds(const Scene& scene);

/// Removes meshes that no instance uses, and renumbers the instances.
void drop_unused_meshes(Scene& scene);

}  // namespace gatelight::scene
