#pragma once
// "--camera all", and "{camera}" in the names of outputs.

#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// The settings of each picture: one, or with --camera all one for each camera of the file. In their outputs
/// "{camera}" is the camera's name, with its index where another one has this name, without characters that
/// end a folder's name. Throws InputError where the file has no camera.
std::vector<RenderSettings> pictures_of(const RenderSettings& settings, const scene::Scene& scene);

/// Before the scene is loaded. Throws BadOption for --camera all where the pictures would have one file.
void check_camera_names(const RenderSettings& settings);

}  // namespace gatelight::apps
