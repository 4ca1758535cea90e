#pragma once
// A view of a whole scene, for files without a camera.

#include "scene/scene.h"

namespace gatelight::renderer {

/// A camera that sees the triangles from the front, from the right and from above: an object stands at three
/// quarters. They fill nine tenths of the picture's width or height, and are in its middle. A few that are
/// very far from the others, or very wide, are not counted. `vertical_fov` is in radians, `aspect` the
/// picture's width over its height.
scene::Camera frame_scene(const scene::Scene& scene, float vertical_fov, float aspect);

}  // namespace gatelight::renderer
