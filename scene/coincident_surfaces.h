#pragma once
// Surfaces that let light pass, in the same plane as other surfaces.

#include "scene/scene.h"

namespace gatelight::scene {

/// A ray that passes a surface starts again a little behind it, and would skip another surface in the same
/// plane: the table under a pane, or the next body of glass. Such surfaces are moved by about two offsets of
/// a ray, which no picture shows. Bodies grow, so that they overlap with what they touch, and nothing is
/// between the two. Sheets move to the front of the other surface. Call it after bake_transforms(). It judges
/// the static pose; meshes that deform stay as they are.
void separate_coincident_surfaces(Scene& scene);

}  // namespace gatelight::scene
