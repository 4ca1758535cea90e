#pragma once
// Lamps with another surface in the same place.

#include "scene/scene.h"

namespace gatelight::scene {

/// Where an opaque triangle that emits has the same corners as other triangles that the same rays see, a ray
/// would meet any of them. Each side keeps one: the emitter that shines there, else the triangle whose front
/// is there, else one that is double-sided. Two that stay are seen from their fronts only (Material::culled).
/// Call it after bake_transforms(): triangles of meshes that are shared or move are compared within their
/// mesh. Returns the materials of which culled copies were added, in order.
std::vector<int> separate_coincident_emitters(Scene& scene);

void add_culled_copy(Scene& scene, int material);

}  // namespace gatelight::scene
