#pragma once
// The last steps of loading, for scenes from a file and from a program.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// Bakes transforms (bake.h) if `bake`, separates doubled lamps, and sets Scene::bounds. Returns the
/// materials of which culled copies were added (coincident_emitters.h).
std::vector<int> finish_geometry(Scene& scene, bool bake);

/// Describes vertices that are too far away or not finite, by the box around them; empty where there are
/// none. Larger coordinates are refused: the square of a triangle's area would overflow single precision.
std::string wrong_bounds(const Scene& scene, const Box& bounds);

}  // namespace gatelight::scene
