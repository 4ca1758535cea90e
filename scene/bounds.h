#pragma once
// The bounding box of a scene in world space.

#include "scene/scene.h"

namespace gatelight::scene {

/// Box around all vertices; empty without any. It is exact up to 100 million transformed vertices; beyond
/// that, shared meshes contribute the corners of their transformed box instead of their vertices.
Box compute_bounds(const Scene& scene);

/// Removes meshes that no instance uses, and updates the instances' mesh indices.
void drop_unused_meshes(Scene& scene);

}  // namespace gatelight::scene
