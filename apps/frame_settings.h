#pragma once
// The settings of one frame of an animation.

#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// The camera, on its way around what it looks at.
renderer::CameraOptions camera_of_frame(const RenderSettings& settings, int frame);

/// The settings of a frame, from those of all frames.
RenderSettings settings_of_frame(const RenderSettings& whole, int frame);

/// The frames that are scouted for a cache, evenly spread.
std::vector<int> scouted_frames(const std::vector<int>& frames);

}  // namespace gatelight::apps
