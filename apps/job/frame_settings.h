#pragma once
// The settings of one frame of an animation.

#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// The camera, on its way around what it looks at.
renderer::CameraOptions camera_of_frame(const RenderSettings& settings, int frame);

/// The settings of a frame, from those of all frames.
RenderSettings settings_of_frame(const RenderSettings& whole, int frame);

/// The last frame of the animation, which begins with frame 0: that of the turn of --turntable, else that of
/// the end of the animations which are shown; 0 where there are none.
int last_frame_of_animation(const RenderSettings& settings, const scene::Scene& scene);

/// Eight of the frames 0 to `last`, or all of fewer, evenly spread: those that are scouted for a cache, or
/// measured.
std::vector<int> sampled_frames(int last);
/// The same of frames that are listed.
std::vector<int> sampled_frames(const std::vector<int>& frames);

/// The frames beside this one whose places the layers of motion need.
std::vector<int> frames_of_motion(const RenderSettings& settings, int frame);

}  // namespace gatelight::apps
