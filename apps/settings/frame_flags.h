#pragma once
// Checks of --frame-groups.

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Throws BadOption where --frame-groups deals frames that depend on the frame before.
void check_frame_groups(const RenderSettings& settings);

/// The same for the integrator, which may be chosen for the scene.
void check_frame_groups(const FrameSettings& frames, renderer::Integrator integrator);

}  // namespace gatelight::apps
