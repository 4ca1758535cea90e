#pragma once
// Moves single-use meshes into world space, so that a scene without real instancing pays for none.

#include "scene/scene.h"

namespace gatelight::scene {

/// Transforms every mesh that one instance uses into world space and makes that instance the identity. Front
/// faces stay front faces: the winding of a mirrored mesh is turned round. A small shared mesh is copied
/// first, where the copies cost less than `copy_budget_triangles` triangles in all (an Embree instance costs
/// a ray more than a few triangles do). Meshes that nobody uses are dropped. Updates Scene::bounds.
void bake_transforms(Scene& scene, std::size_t copy_budget_triangles = 65536);

/// No ray can be carried into the mesh's own space: scaled flat, or nearly so. Such an instance gets a mesh
/// of its own.
bool is_flat(const Affine& transform);

}  // namespace gatelight::scene
