#pragma once
// Moves meshes that one instance uses into world space, so that rays need no instance transform there.

#include "scene/scene.h"

namespace gatelight::scene {

/// Transforms every mesh that one instance uses into world space and gives that instance the identity. Front
/// faces stay front faces: a mirrored mesh gets its winding reversed. Small shared meshes are copied first,
/// the cheapest ones first, up to `copy_budget_triangles` additional triangles in all: an Embree instance
/// costs a ray more than a few triangles do. Unused meshes are dropped. Updates Scene::bounds.
void bake_transforms(Scene& scene, std::size_t copy_budget_triangles = 65536);

/// Whether the transform is singular or nearly so: a ray cannot be transformed into the mesh's space then.
/// Such an instance gets its own copy of the mesh.
bool is_flat(const Affine& transform);

}  // namespace gatelight::scene
