#pragma once
// Selects the camera of a picture.

#include <vector>

#include "renderer/settings/options.h"
#include "renderer/settings/view.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The view that the options select: by position, name or index; otherwise the first of the file, or one that
/// frames the whole scene if the file has none; with its lens. Throws BadOption that names the choices, or
/// for a camera so far away (1e12 m) that its rays would leave single precision.
View choose_camera(const scene::Scene& scene, const CameraOptions& options, float aspect);

/// The same view at evenly spaced times, from the opening to the closing of the scene's shutter; empty where
/// it stands still. `view` is that of the middle, with its focus distance.
std::vector<View> shutter_views(const scene::Scene& scene, const CameraOptions& options, float aspect,
                                const View& view);

}  // namespace gatelight::renderer
