#pragma once
// Real files contain normals of length zero and texture coordinates that are not finite, mostly at degenerate
// triangles. These functions repair them; only bad positions are refused.

#include "scene/scene.h"

namespace gatelight::scene {

/// Normalises normals. One that has no direction is replaced by the area-weighted normal of its triangles.
/// Returns whether any was replaced.
bool repair_normals(Mesh& mesh);

/// Replaces texture coordinates that are not finite by zero. Returns whether any was replaced.
bool repair_uvs(Mesh& mesh);

/// Normalises tangents and sets the handedness to +1 or -1. One that has no direction is replaced.
void repair_tangents(Mesh& mesh);

}  // namespace gatelight::scene
