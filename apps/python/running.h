#pragma once
// What renders of a picture and of frames share.

#include <pybind11/pybind11.h>

#include "apps/python/picture_data.h"
#include "apps/python/scene_data.h"
#include "apps/reports/run_report.h"
#include "apps/settings/render_settings.h"
#include "renderer/settings/statistics.h"

namespace gatelight::python {

/// The complete settings of a render of this scene. Throws BadOption.
apps::RenderSettings settings_for(const SceneData& scene, const pybind11::dict& keywords);

/// The picture with its recipe and statistics, and in the files of the options.
PicturePointer finish_picture(renderer::Picture picture, const renderer::RenderStatistics& statistics,
                              const apps::RenderSettings& settings, apps::RunReport report);

/// As Python's own warnings. Throws error_already_set where the user made them errors.
void show_warnings(const PictureData& picture);

}  // namespace gatelight::python
