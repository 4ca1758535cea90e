#pragma once
// Moves meshes that one instance uses into world space, so that rays need no instance transform there. Also
// computes the scene's bounds and removes meshes without an instance.

#include "scene/scene.h"

namespace gatelight::scene {

/// Transforms every mesh that one instance uses into world space and gives that instance the identity. Front
/// faces stay front faces: a mirrored mesh gets its winding reversed. Small shared meshes are copied first,
/// the cheapest ones first, up to `copy_budget_triangles` additional triangles in all: an Embree instance
/// costs a ray more than a few triangles do. Instances that move stay as they are. Unused meshes are dropped.
/// Updates Scene::bounds.
void bake_transforms(Scene& scene, std::size_t copy_budget_triangles = 65536);

/// Whether the transform is singular or nearly so: a ray cannot be transformed into the mesh's space then.
/// Such an instance gets its own copy of the mesh.
bool is_flat(const Affine& transform);

/// Box around all vertices; empty without any. It is exact up to 100 million transformed vertices; beyond
/// that, shared meshes contribute the corners of their transformed box instead of their vertices.
Box compute_bounds(const Scene& scene);

/// Removes meshes that no instance uses, and updates the instances' mesh indices.
void drop_unused_meshes(Scene& scene);

}  // namespace gatelight::scene
