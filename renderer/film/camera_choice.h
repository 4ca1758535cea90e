#pragma once
// Which camera a picture is taken with.

#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The camera that the options ask for: given by hand, named or indexed, the first of the file, or one that
/// frames the whole scene where there is none. Throws BadOption naming the choices, or for a camera so far
/// away (1e12 m) that its rays would leave single precision.
scene::Camera choose_camera(const scene::Scene& scene, const CameraOptions& options, float aspect);

}  // namespace gatelight::renderer
