#pragma once
// The last steps of loading, for scenes read from a file or built by a program.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// Bakes transforms (bake.h) if `bake` is true, separates coincident emitters (coincident_emitters.h), and
/// sets Scene::bounds. Returns the materials that got a culled copy.
std::vector<int> finish_geometry(Scene& scene, bool bake);

/// Describes vertices that are too far away or not finite by their bounding box; returns an empty string if
/// there are none. The limit keeps the square of a triangle's area within single precision.
std::string wrong_bounds(const Scene& scene, const Box& bounds);

}  // namespace gatelight::scene
