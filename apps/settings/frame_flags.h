#pragma once
// Checks of flags that need frames.

#include <string>
#include <string_view>
#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// The name that ffmpeg has for the container of a file; empty for an extension that is none of a film.
std::string_view film_format(const std::string& file);

/// The output whose files a film is made of: the first PNG, which is as displayed, else the first EXR or HDR.
/// Empty: none of them can be read.
std::string film_source(const std::vector<std::string>& outputs);

/// Throws UsageError where --preview-video has another extension, no frames, or no files to be made of.
void check_film(const RenderSettings& settings);

/// Throws UsageError where --frame-groups deals frames that depend on the frame before.
void check_frame_groups(const RenderSettings& settings);

/// The same for the integrator, which may be chosen for the scene.
void check_frame_groups(const FrameSettings& frames, renderer::Integrator integrator);

}  // namespace gatelight::apps
