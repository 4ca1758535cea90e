#pragma once
// Real files hold normals of length zero and texture coordinates that are not numbers, mostly at degenerate
// triangles. They are mended rather than refused: only positions decide what there is.

#include "scene/scene.h"

namespace gatelight::scene {

/// Normalises normals; those that cannot be are replaced by the area-weighted normal of their triangles. True
/// if any.
bool repair_normals(Mesh& mesh);

/// Replaces coordinates that are not finite by zero. True if any.
bool repair_uvs(Mesh& mesh);

/// Normalises tangents, makes handedness +1 or -1, and replaces those that cannot be.
void repair_tangents(Mesh& mesh);

}  // namespace gatelight::scene
